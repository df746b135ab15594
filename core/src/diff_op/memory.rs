//! Memory of a step, kept from batch to batch: a fresh one per batch would be written to and given back to the system
//! every time, which takes as long as painting some images.

use core::ops::{Deref, DerefMut};

/// What runs of items leave for later ones: as many as have run side by side. Without std nothing is kept.
pub(super) struct Memory<S> {
    #[cfg(feature = "std")]
    kept: std::sync::Mutex<alloc::vec::Vec<S>>,
    #[cfg(not(feature = "std"))]
    kept: core::marker::PhantomData<fn() -> S>,
}

impl<S> Default for Memory<S> {
    fn default() -> Self {
        Self { kept: Default::default() }
    }
}

impl<S: Default> Memory<S> {
    /// One for a run of items.
    pub(super) fn take(&self) -> Taken<'_, S> {
        Taken { scratch: self.pop().unwrap_or_default(), memory: self }
    }

    #[cfg(feature = "std")]
    fn pop(&self) -> Option<S> {
        self.kept.lock().unwrap_or_else(std::sync::PoisonError::into_inner).pop()
    }

    #[cfg(feature = "std")]
    fn push(&self, scratch: S) {
        self.kept.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(scratch);
    }

    #[cfg(not(feature = "std"))]
    #[expect(clippy::unused_self, reason = "there is no lock to keep anything behind")]
    fn pop(&self) -> Option<S> {
        None
    }

    #[cfg(not(feature = "std"))]
    #[expect(clippy::unused_self, reason = "there is no lock to keep anything behind")]
    fn push(&self, _: S) {}
}

/// Memory in use; goes back when dropped.
pub(super) struct Taken<'a, S: Default> {
    scratch: S,
    memory: &'a Memory<S>,
}

impl<S: Default> Deref for Taken<'_, S> {
    type Target = S;

    fn deref(&self) -> &S {
        &self.scratch
    }
}

impl<S: Default> DerefMut for Taken<'_, S> {
    fn deref_mut(&mut self) -> &mut S {
        &mut self.scratch
    }
}

impl<S: Default> Drop for Taken<'_, S> {
    fn drop(&mut self) {
        self.memory.push(core::mem::take(&mut self.scratch));
    }
}
