//! A fingerprint of a recording: equal exactly if every number is, bit for bit.

use std::fmt::Write;

use sha2::{Digest, Sha256};

use super::Recording;

/// Bytes of the hash that are kept: two recordings that differ have the same by chance once in
/// 2^64 of them.
const KEPT: usize = 16;

impl Recording {
    /// The fingerprint of all states: SHA-256 over their bits, sample after sample, body after
    /// body, position before velocity, least significant byte first; 32 hexadecimal digits.
    #[must_use]
    pub fn digest(&self) -> String {
        let mut hash = Sha256::new();
        hash.update((self.body_count as u64).to_le_bytes());
        for state in self.samples().flatten() {
            for value in state.position.iter().chain(&state.velocity) {
                hash.update(value.to_bits().to_le_bytes());
            }
        }
        let kept = hash.finalize();
        kept.iter()
            .take(KEPT)
            .fold(String::new(), |mut text, byte| {
                // Writing to a string cannot fail.
                let _ = write!(text, "{byte:02x}");
                text
            })
    }
}

#[cfg(test)]
mod tests {
    use crate::recording::{Recording, initial_states};

    /// `python3 -c "import hashlib,struct;print(hashlib.sha256(struct.pack('<Q6d',1,1,2,3,4,5,6)).hexdigest()[:32])"`
    #[test]
    fn the_digest_is_that_of_the_bits() {
        let text = "name='x'\nduration=1\nsample_every=1\n[[bodies]]\nname='a'\nmass=1\n\
            radius=1\nposition=[1,2,3]\nvelocity=[4,5,6]\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let start = Recording::at_start("x", &scene);
        assert_eq!(start.digest(), "4c958ef7edd6c8777f460b8b7adde302");
        let mut moved = start.clone();
        let mut states = initial_states(&scene);
        states[0].velocity.x = 4.0_f64.next_up();
        moved.push(&states);
        let mut other = start.clone();
        other.push(&initial_states(&scene));
        assert_ne!(moved.digest(), other.digest());
    }
}
