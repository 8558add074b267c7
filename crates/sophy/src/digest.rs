use sha2::{Digest, Sha256};
use sophy_diagnostics::{World, WorldError};
use std::cell::RefCell;
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A world that remembers the digest of all that was read from it, in order.
pub(crate) struct Digesting<'w> {
    world: &'w dyn World,
    // A world is read through `&self`.
    digest: RefCell<Sha256>,
}

impl<'w> Digesting<'w> {
    pub(crate) fn new(world: &'w dyn World) -> Self {
        Digesting { world, digest: RefCell::default() }
    }

    /// SHA-256 of all bytes read so far, as hexadecimal digits.
    pub(crate) fn hash(&self) -> String {
        let digest = self.digest.borrow().clone().finalize();
        digest.iter().fold(String::new(), |mut text, byte| {
            // Writing into a string does not fail.
            let _ = write!(text, "{byte:02x}");
            text
        })
    }
}

impl World for Digesting<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>, WorldError> {
        let bytes = self.world.read(path)?;
        self.digest.borrow_mut().update(&bytes);
        Ok(bytes)
    }

    fn identity(&self, path: &Path) -> PathBuf {
        self.world.identity(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use sophy_diagnostics::MemoryWorld;

    /// The digest of `abc` is the example of FIPS 180-2, appendix B.1.
    #[test]
    fn files_count_as_one_text_and_failures_not_at_all() {
        let files = MemoryWorld::default().with("a", "a").with("bc", "bc");
        let world = Digesting::new(&files);
        assert!(world.read(Path::new("a")).is_ok());
        assert!(world.read(Path::new("missing")).is_err());
        assert!(world.read(Path::new("bc")).is_ok());
        assert_eq!(world.hash(), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    }
}
