//! Records of TensorFlow (`.tfrecords`), plain or gzipped.
//!
//! ```text
//! length u64 | masked CRC32C of the length u32 | the record | masked CRC32C of the record u32
//! ```
//!
//! Numbers are little-endian. *Source*: the format as TensorFlow documents it; CRC32C is RFC 3720.

use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::{Path, PathBuf};

use flate2::bufread::MultiGzDecoder;

use super::{FormatError, Place};

/// Longest record that is read: pictures of the sets are below 1 MiB.
const MOST_BYTES: u64 = 1 << 28;
/// The first bytes of gzip.
const GZIP: [u8; 2] = [0x1f, 0x8b];

/// The records of a file, one after the other, each held against its checksum.
pub(crate) struct TfRecords {
    reader: Box<dyn Read>,
    path: PathBuf,
    /// Records read.
    count: u64,
}

/// The checksum as it stands in a file: turned by 15 bits and moved, so that a checksum of bytes that hold checksums is none of theirs.
pub(crate) fn masked_crc(bytes: &[u8]) -> u32 {
    crc32c::crc32c(bytes).rotate_right(15).wrapping_add(0xa282_ead8)
}

impl TfRecords {
    /// Opens a file; gzip is told by its first bytes.
    ///
    /// # Errors
    /// [`FormatError::Read`].
    pub(crate) fn open(path: &Path) -> Result<Self, FormatError> {
        let refused = |source| FormatError::Read { path: path.to_path_buf(), source };
        let mut file = BufReader::new(File::open(path).map_err(refused)?);
        let is_gzip = file.fill_buf().map_err(refused)?.starts_with(&GZIP);
        let reader: Box<dyn Read> = if is_gzip { Box::new(MultiGzDecoder::new(file)) } else { Box::new(file) };
        Ok(Self { reader, path: path.to_path_buf(), count: 0 })
    }

    /// What is wrong with the record being read.
    fn wrong(&self, problem: &str) -> FormatError {
        let field = format!("record {}", self.count + 1);
        FormatError::Field { place: Place::file(&self.path), field, problem: problem.to_owned() }
    }

    fn refused(&self, error: std::io::Error) -> FormatError {
        match error.kind() {
            ErrorKind::UnexpectedEof => self.wrong("ends too early: the file is truncated; fetch it again"),
            ErrorKind::InvalidData | ErrorKind::InvalidInput => {
                self.wrong("cannot be unpacked: the file is damaged; fetch it again")
            }
            _ => FormatError::Read { path: self.path.clone(), source: error },
        }
    }

    /// The next record; none at the end of the file.
    fn record(&mut self) -> Result<Option<Vec<u8>>, FormatError> {
        let (mut length, mut check) = ([0; 8], [0; 4]);
        // A file ends before a record, not inside one.
        if self.reader.read(&mut length[..1]).map_err(|error| self.refused(error))? == 0 {
            return Ok(None);
        }
        self.reader.read_exact(&mut length[1..]).map_err(|error| self.refused(error))?;
        self.reader.read_exact(&mut check).map_err(|error| self.refused(error))?;
        if masked_crc(&length) != u32::from_le_bytes(check) {
            return Err(self.wrong("begins with a length that its checksum denies: no TFRecord file, or a damaged one"));
        }
        let length = u64::from_le_bytes(length);
        if length > MOST_BYTES {
            return Err(self.wrong(&format!("is {length} bytes long, at most {MOST_BYTES} are read")));
        }
        let mut record = Vec::new();
        (&mut self.reader).take(length).read_to_end(&mut record).map_err(|error| self.refused(error))?;
        if record.len() as u64 != length {
            return Err(self.refused(ErrorKind::UnexpectedEof.into()));
        }
        self.reader.read_exact(&mut check).map_err(|error| self.refused(error))?;
        if masked_crc(&record) != u32::from_le_bytes(check) {
            return Err(self.wrong("has another checksum than it should: the file is damaged; fetch it again"));
        }
        self.count += 1;
        Ok(Some(record))
    }
}

impl Iterator for TfRecords {
    type Item = Result<Vec<u8>, FormatError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.record().transpose()
    }
}
