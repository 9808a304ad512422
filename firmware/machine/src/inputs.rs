//! What a board reads.

/// Switches and scales, as the pins of a board read them.
pub trait Inputs<const N: usize> {
    /// Which home switches are closed.
    fn closed(&self) -> [bool; N];

    /// What the counters of the scales read, which wrap at 2^16; none where the board has none.
    fn counts(&self) -> Option<[u16; N]> {
        None
    }
}
