//! Files that are there whole or not at all.

use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::Path;

use super::FormatError;

/// Puts `bytes` into `path`: written to a temporary file in the same folder, then renamed. A reader, or a program that
/// stops half-way, sees the old file or the new one. Missing parent folders are made.
///
/// A target that is no regular file (`/dev/stdout`, a pipe) is written to directly; a symbolic link is followed.
///
/// # Errors
/// [`FormatError::Write`] with the system's reason; the temporary file is removed.
pub fn write_atomic(path: &Path, bytes: &[u8]) -> Result<(), FormatError> {
    let refused = |source| FormatError::Write { path: path.to_path_buf(), source };
    let (target, there) = match fs::symlink_metadata(path) {
        Ok(link) if link.is_symlink() => {
            (fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf()), fs::metadata(path).ok())
        }
        found => (path.to_path_buf(), found.ok()),
    };
    match there {
        Some(meta) if meta.is_dir() => return Err(refused(ErrorKind::IsADirectory.into())),
        Some(meta) if !meta.is_file() => {
            let mut device = OpenOptions::new().write(true).open(path).map_err(refused)?;
            return device.write_all(bytes).map_err(refused);
        }
        _ => (),
    }
    let folder = match target.parent() {
        Some(folder) if folder != Path::new("") => folder,
        _ => Path::new("."),
    };
    let mut builder = tempfile::Builder::new();
    builder.prefix(".dvp-").suffix(".part");
    #[cfg(unix)]
    {
        // tempfile's 0600 would make results private; the user's umask decides.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let made = match builder.tempfile_in(folder) {
        Err(error) if error.kind() == ErrorKind::NotFound => {
            fs::create_dir_all(folder).and_then(|()| builder.tempfile_in(folder))
        }
        made => made,
    };
    let mut file = made.map_err(refused)?;
    file.write_all(bytes).map_err(refused)?;
    file.persist(&target).map_err(|error| refused(error.error))?;
    Ok(())
}
