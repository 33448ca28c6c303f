//! Which files of a folder carom wrote: those that its summary lists, while they are unchanged.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::Path;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::SUMMARY;
use crate::input::{self, STORED_BYTES_MAX};

/// Digests of files by their names within one folder.
pub(super) type Listing = BTreeMap<String, String>;

/// What stands before the digest of a summary, which is taken of all the bytes before it.
const DIGEST: &str = ",\n  \"digest\": \"";

/// A summary with the files of its folder.
#[derive(Serialize)]
struct Listed<'a, T> {
    #[serde(flatten)]
    summary: &'a T,
    /// Whether more of the result is to come.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    unfinished: bool,
    /// SHA-256 of each other file of the result, as hexadecimal digits.
    files: &'a Listing,
}

/// What of a summary is read to recognise it.
#[derive(Deserialize)]
struct Recognised {
    #[serde(default)]
    unfinished: bool,
    files: Listing,
}

/// The text of a summary with the files of its folder, and a digest of itself.
pub(super) fn listed(
    summary: &impl Serialize,
    files: &Listing,
    unfinished: bool,
) -> io::Result<String> {
    let listed = Listed {
        summary,
        unfinished,
        files,
    };
    let text = serde_json::to_string_pretty(&listed)?;
    let body = text.strip_suffix("\n}").unwrap_or(&text);
    let own = digest(body.as_bytes())?;
    Ok(format!("{body}{DIGEST}{own}\"\n}}\n"))
}

/// The files that the summary in a folder lists, of a whole result or of an unfinished one; none
/// where no such summary of carom stands, or where it was changed.
pub(super) fn listing(folder: &Path, unfinished: bool) -> Option<Listing> {
    let path = folder.join(SUMMARY);
    if !fs::symlink_metadata(&path).ok()?.is_file() {
        return None;
    }
    let text = input::text(&path, STORED_BYTES_MAX).ok()?;
    let (body, own) = text.rsplit_once(DIGEST)?;
    if own != format!("{}\"\n}}\n", digest(body.as_bytes()).ok()?) {
        return None;
    }
    let recognised: Recognised = serde_json::from_str(&text).ok()?;
    let plain = recognised.files.keys().all(|name| is_plain(name));
    (plain && recognised.unfinished == unfinished).then_some(recognised.files)
}

/// Whether a name is that of a file in its own folder.
fn is_plain(name: &str) -> bool {
    let only = Path::new(name).file_name();
    only.is_some_and(|only| only == name) && name.len() <= 255 && !name.contains('\0')
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
pub(super) fn digest(mut input: impl Read) -> io::Result<String> {
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
        assert!(listing(folder, false).is_none());
        let abc = digest(&b"abc"[..]).unwrap();
        let names = ["a.csv", "b.csv"].map(|name| (name.to_owned(), abc.clone()));
        let text = |unfinished| {
            let figures = serde_json::json!({"x": 1, "digest": "mine"});
            listed(&figures, &Listing::from(names.clone()), unfinished).unwrap()
        };
        write(SUMMARY, &text(false));
        write("b.csv", "abd");
        fs::create_dir(folder.join("d.csv")).unwrap();
        let listing = listing(folder, false);
        let found = |name| Found::at(folder, name, listing.as_ref()).unwrap();
        assert_eq!(found("a.csv"), Found::Own);
        assert_eq!(found("b.csv"), Found::Changed);
        assert_eq!(found("c.csv"), Found::Foreign);
        assert_eq!(found("d.csv"), Found::Blocked);
        assert_eq!(found("e.csv"), Found::Free);
        assert_eq!(found(SUMMARY), Found::Own);
        for foreign in [
            "{\"figures\": [1, 2]}",
            "{\"files\": {}, \"mine\": 1}",
            &text(false).replacen("\"x\": 1", "\"x\": 2", 1),
            &format!("{}\n", text(false)),
            &text(true),
        ] {
            write(SUMMARY, foreign);
            assert!(super::listing(folder, false).is_none(), "{foreign}");
        }
        write(SUMMARY, &text(false));
        assert!(super::listing(folder, true).is_none());
        write(SUMMARY, &text(true));
        assert_eq!(super::listing(folder, true).unwrap().len(), 2);
        let odd = Listing::from([("../x".to_owned(), abc)]);
        write(
            SUMMARY,
            &listed(&serde_json::json!({}), &odd, false).unwrap(),
        );
        assert!(
            super::listing(folder, false).is_none(),
            "a name of another folder"
        );
    }
}
