//! What must not link: the proof of the proof.

#[cfg(feature = "control-alloc")]
extern crate alloc;
#[cfg(feature = "control-std")]
extern crate std;

pub fn run() {
    #[cfg(feature = "control-alloc")]
    core::hint::black_box(alloc::vec![core::hint::black_box(1_u8)]);
}
