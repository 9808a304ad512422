//! One block as it stands on the line, without a link around it.
//!
//! ```text
//! body = payload with every 10h doubled, 10h, 03h, [BCC]
//! BCC  = XOR of all characters of the body before it          (3964R only)
//! ```
//! The STX before the block is not part of the body: it is sent, and answered, first. The block
//! check character (BCC) is one raw character of any value and is never doubled; the XOR over a
//! whole body with its BCC is 0. A doubled DLE cancels itself in the BCC.

mod decoder;
mod encoder;
#[cfg(test)]
mod tests;

pub use decoder::{DecodeError, Decoder, FrameError, IllegalDle, decode};
pub(crate) use decoder::{Progress, Rules};
pub use encoder::{EncodeError, encode, max_encoded_len};
pub(crate) use encoder::{Encoder, encoded_len};

/// Whether a block ends in a check character.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "the procedure has these two forms")]
pub enum Check {
    /// 3964: the block ends with DLE ETX.
    None,
    /// 3964R: the block check character follows DLE ETX.
    #[default]
    Bcc,
}
