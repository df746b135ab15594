//! The allocator: one static block, handed out from the front, never taken back.
//!
//! `unsafe` cannot be avoided here: the trait of global allocators is unsafe. This crate is no part of the workspace,
//! whose crates all forbid it.

use core::alloc::{GlobalAlloc, Layout};
use core::cell::UnsafeCell;
use core::ptr::null_mut;
use core::sync::atomic::{AtomicUsize, Ordering};

const BYTES: usize = 256 << 20;

#[repr(align(4096))]
struct Block(UnsafeCell<[u8; BYTES]>);

// SAFETY: `alloc` hands out each byte once.
unsafe impl Sync for Block {}

static BLOCK: Block = Block(UnsafeCell::new([0; BYTES]));
static USED: AtomicUsize = AtomicUsize::new(0);

struct Bump;

#[global_allocator]
static HEAP: Bump = Bump;

// SAFETY: ranges are disjoint, inside the block, and aligned up to the block's own 4096 bytes.
unsafe impl GlobalAlloc for Bump {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        if layout.align() > 4096 {
            return null_mut();
        }
        let mut start = 0;
        let claimed = USED.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |used| {
            start = used.next_multiple_of(layout.align());
            start.checked_add(layout.size()).filter(|&end| end <= BYTES)
        });
        if claimed.is_err() {
            return null_mut();
        }
        // SAFETY: `start` plus the size is at most BYTES.
        unsafe { BLOCK.0.get().cast::<u8>().add(start) }
    }

    unsafe fn dealloc(&self, _: *mut u8, _: Layout) {}
}
