//! Which files of a folder carom wrote: those that its summary lists, while they are unchanged.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::SUMMARY;

/// Larger summaries than this are not read: carom writes none. The index of all reference cases
/// is 0.3 MB.
const SUMMARY_BYTES_MAX: u64 = 1 << 28;

/// Digests of files by their names within one folder.
pub(super) type Listing = BTreeMap<String, String>;

/// A summary with the files of its folder.
#[derive(Serialize)]
pub(super) struct Listed<'a, T> {
    #[serde(flatten)]
    pub summary: &'a T,
    /// SHA-256 of each other file of the result, as hexadecimal digits.
    pub files: &'a Listing,
}

/// What of a summary is read to recognise it.
#[derive(Deserialize)]
struct Recognised {
    files: Listing,
}

/// The files that the summary in a folder lists; none where no summary of carom stands.
pub(super) fn listing(folder: &Path) -> Option<Listing> {
    let path = folder.join(SUMMARY);
    let found = fs::symlink_metadata(&path).ok()?;
    if !found.is_file() || found.len() > SUMMARY_BYTES_MAX {
        return None;
    }
    let bytes = fs::read(&path).ok()?;
    let recognised: Recognised = serde_json::from_slice(&bytes).ok()?;
    Some(recognised.files)
}

/// What stands where a file is to be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Found {
    /// Nothing.
    Free,
    /// A file of carom's, as it was written.
    Own,
    /// A file that carom wrote and somebody changed.
    Changed,
    /// A file that no summary of carom lists.
    Foreign,
    /// A symbolic link.
    Link,
    /// A folder, a device or anything else that is no regular file.
    Blocked,
}

impl Found {
    /// What stands at `name` in `folder`, whose summary lists `listing`.
    pub fn at(folder: &Path, name: &str, listing: Option<&Listing>) -> io::Result<Self> {
        let path = folder.join(name);
        let metadata = match fs::symlink_metadata(&path) {
            Ok(metadata) => metadata,
            Err(wrong) if wrong.kind() == io::ErrorKind::NotFound => return Ok(Self::Free),
            Err(wrong) => return Err(wrong),
        };
        if metadata.is_symlink() {
            return Ok(Self::Link);
        }
        if !metadata.is_file() {
            return Ok(Self::Blocked);
        }
        let Some(listing) = listing else {
            return Ok(Self::Foreign);
        };
        if name == SUMMARY {
            return Ok(Self::Own);
        }
        let Some(written) = listing.get(name) else {
            return Ok(Self::Foreign);
        };
        let same = *written == digest(File::open(&path)?)?;
        Ok(if same { Self::Own } else { Self::Changed })
    }
}

/// SHA-256 of all that is read, as hexadecimal digits.
fn digest(mut input: impl Read) -> io::Result<String> {
    let mut hashed = Hashed::new(io::sink());
    io::copy(&mut input, &mut hashed)?;
    Ok(hashed.finish().0)
}

/// A writer that takes the digest of what passes.
pub(super) struct Hashed<W> {
    out: W,
    hash: Sha256,
}

impl<W: Write> Hashed<W> {
    pub fn new(out: W) -> Self {
        let hash = Sha256::new();
        Self { out, hash }
    }

    /// The digest as hexadecimal digits, and the writer.
    pub fn finish(self) -> (String, W) {
        let digest = self.hash.finalize();
        let digits = digest.iter().fold(String::new(), |mut digits, byte| {
            // Writing to a string cannot fail.
            let _ = write!(digits, "{byte:02x}");
            digits
        });
        (digits, self.out)
    }
}

impl<W: Write> Write for Hashed<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.out.write(bytes)?;
        self.hash.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `printf abc | sha256sum`
    #[test]
    fn the_digest_is_sha_256() {
        assert_eq!(
            digest(&b"abc"[..]).unwrap(),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"
        );
    }

    #[test]
    fn only_what_is_listed_and_unchanged_is_own() {
        let scratch = tempfile::tempdir().unwrap();
        let folder = scratch.path();
        let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
        write("a.csv", "abc");
        write("b.csv", "abc");
        write("c.csv", "abc");
        assert!(listing(folder).is_none());
        let abc = digest(&b"abc"[..]).unwrap();
        write(
            SUMMARY,
            &format!("{{\"x\": 1, \"files\": {{\"a.csv\": \"{abc}\", \"b.csv\": \"{abc}\"}}}}"),
        );
        write("b.csv", "abd");
        fs::create_dir(folder.join("d.csv")).unwrap();
        let listing = listing(folder);
        let found = |name| Found::at(folder, name, listing.as_ref()).unwrap();
        assert_eq!(found("a.csv"), Found::Own);
        assert_eq!(found("b.csv"), Found::Changed);
        assert_eq!(found("c.csv"), Found::Foreign);
        assert_eq!(found("d.csv"), Found::Blocked);
        assert_eq!(found("e.csv"), Found::Free);
        assert_eq!(found(SUMMARY), Found::Own);
        write(SUMMARY, "{\"figures\": [1, 2]}");
        assert!(
            super::listing(folder).is_none(),
            "a summary of another program"
        );
    }
}
