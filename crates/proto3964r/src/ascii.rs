//! The four control characters of the procedure.

/// Start of text: asks the partner to receive.
pub const STX: u8 = 0x02;
/// End of text: ends a block when it stands after a single [`DLE`].
pub const ETX: u8 = 0x03;
/// Data link escape: the positive answer, and the escape inside a block.
pub const DLE: u8 = 0x10;
/// Negative acknowledge: the negative answer.
pub const NAK: u8 = 0x15;
