//! A single file that the user named.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use crate::error::{Error, Result};

/// Writes one file whole: beside its place under another name, then renamed.
///
/// What stands there, be it a file or a link to one, is replaced only if `force` says so; a link
/// is then replaced itself, and what it leads to stays as it is.
///
/// # Errors
/// [`Error::Exists`] if something stands there, [`Error::Write`] if the file cannot be written.
pub fn write_file(path: &Path, force: bool, bytes: &[u8]) -> Result<()> {
    let folder = path.parent().filter(|it| !it.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    let unwritable = |source| Error::write(path, source);
    fs::create_dir_all(folder).map_err(unwritable)?;
    let mut builder = tempfile::Builder::new();
    builder.prefix(".carom-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    let mut file = builder.tempfile_in(folder).map_err(unwritable)?;
    file.write_all(bytes).map_err(unwritable)?;
    let placed = if force {
        file.persist(path)
    } else {
        file.persist_noclobber(path)
    };
    placed.map(drop).map_err(|wrong| match wrong.error {
        exists if exists.kind() == io::ErrorKind::AlreadyExists => Error::Exists {
            path: path.to_owned(),
        },
        source => Error::write(path, source),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_is_replaced_unasked_not_even_a_link_to_nowhere() {
        let scratch = tempfile::tempdir().unwrap();
        let path = scratch.path().join("a.toml");
        write_file(&path, false, b"old").unwrap();
        let said = write_file(&path, false, b"new").unwrap_err().to_string();
        assert!(said.contains("--force"), "{said}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        write_file(&path, true, b"new").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"new");
        #[cfg(unix)]
        {
            let (real, link) = (scratch.path().join("real"), scratch.path().join("link"));
            std::os::unix::fs::symlink(&real, &link).unwrap();
            assert!(write_file(&link, false, b"new").is_err());
            assert!(!real.exists() && fs::symlink_metadata(&link).unwrap().is_symlink());
            fs::write(&real, "precious").unwrap();
            write_file(&link, true, b"new").unwrap();
            assert_eq!(fs::read(&real).unwrap(), b"precious");
            assert!(fs::symlink_metadata(&link).unwrap().is_file());
        }
        assert_eq!(
            fs::read_dir(scratch.path()).unwrap().count(),
            if cfg!(unix) { 3 } else { 1 }
        );
    }
}
