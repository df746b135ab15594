//! Files that are there whole or not at all.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

use super::error::FormatError;

/// Puts `bytes` into `path`: written to a temporary file in the same folder, then renamed. A reader, or a program that
/// stops half-way, sees the old file or the new one. Missing parent folders are made.
///
/// A target that is no regular file (`/dev/stdout`, a pipe) is written to directly; a symbolic link is followed.
///
/// # Errors
/// [`FormatError::Write`] with the system's reason; the temporary file is removed.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), FormatError> {
    let refused = |source| FormatError::Write { path: path.to_path_buf(), source };
    let target = match fs::metadata(path) {
        Ok(meta) if meta.is_dir() => return Err(refused(std::io::ErrorKind::IsADirectory.into())),
        Ok(meta) if !meta.is_file() => {
            let mut device = OpenOptions::new().write(true).open(path).map_err(refused)?;
            return device.write_all(bytes).map_err(refused);
        }
        Ok(_) => fs::canonicalize(path).map_err(refused)?,
        Err(_) => path.to_path_buf(),
    };
    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder.to_path_buf(),
        _ => PathBuf::from("."),
    };
    fs::create_dir_all(&folder).map_err(refused)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".dvp-").suffix(".part");
    #[cfg(unix)]
    {
        // tempfile's 0600 would make results private; the user's umask decides.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(&folder).map_err(refused)?;
    file.write_all(bytes).map_err(refused)?;
    file.persist(&target).map_err(|error| refused(error.error))?;
    Ok(())
}
