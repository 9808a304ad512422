//! The body of a block as it goes over the line: DLE doubled, DLE ETX, check character.

use proto3964r::frame::{Check, EncodeError, encode, max_encoded_len};

/// The longest payload that this program sends.
const LONGEST: usize = 16;

fn main() -> Result<(), EncodeError> {
    let mut body = [0; max_encoded_len(LONGEST)];
    for payload in [b"tare".as_slice(), &[0x01, 0x10, 0x02]] {
        let len = encode(payload, Check::Bcc, &mut body)?;
        println!(
            "{payload:02X?}: {:02X?}",
            body.get(..len).unwrap_or_default()
        );
    }
    Ok(())
}
