//! The marks of a Unix terminal whose input flag `PARMRK` is set.

use proto3964r::{CharacterError, tokio::Damage};

use super::heard::Heard;

const ESCAPE: u8 = 0xFF;

/// Reads the characters of a terminal with `PARMRK`.
///
/// ```text
/// FF FF    the character FF
/// FF 00 00 BREAK, or 00 with a wrong parity or stop bit
/// FF 00 x  x with a wrong parity or stop bit
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub(crate) enum Marks {
    /// Between characters.
    #[default]
    Plain,
    /// After FF.
    Escape,
    /// After FF 00.
    Mark,
}

impl Marks {
    /// Takes a byte of the terminal; returns what it completes.
    pub(crate) fn take(&mut self, byte: u8) -> Option<Heard> {
        let (next, heard) = match (*self, byte) {
            (Self::Plain, ESCAPE) => (Self::Escape, None),
            (Self::Escape, 0) => (Self::Mark, None),
            // After FF comes FF or 00; whatever else is a character.
            (Self::Plain | Self::Escape, byte) => (Self::Plain, Some(Ok(byte))),
            (Self::Mark, 0) => (Self::Plain, Some(Err(Damage::Break))),
            (Self::Mark, byte) => (Self::Plain, Some(damaged(byte))),
        };
        *self = next;
        heard
    }
}

/// A character with a wrong parity bit, or a wrong stop bit: Linux does not tell which.
const fn damaged(byte: u8) -> Heard {
    Err(Damage::Character {
        byte,
        error: CharacterError::Parity,
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// As a terminal writes it.
    fn marked(heard: &[Heard]) -> Vec<u8> {
        let bytes = heard.iter().flat_map(|heard| match *heard {
            Ok(ESCAPE) => vec![ESCAPE, ESCAPE],
            Ok(byte) => vec![byte],
            Err(Damage::Character { byte, .. }) => vec![ESCAPE, 0, byte],
            Err(_) => vec![ESCAPE, 0, 0],
        });
        bytes.collect()
    }

    fn any_heard() -> impl Strategy<Value = Heard> {
        prop_oneof![
            any::<u8>().prop_map(Ok),
            Just(Ok(ESCAPE)),
            Just(Ok(0)),
            (1..=u8::MAX).prop_map(damaged),
            Just(Err(Damage::Break)),
        ]
    }

    proptest! {
        #[test]
        fn what_a_terminal_marks_is_heard(heard in prop::collection::vec(any_heard(), 0..64)) {
            let mut marks = Marks::default();
            let read: Vec<_> = marked(&heard).into_iter().filter_map(|byte| marks.take(byte)).collect();
            prop_assert_eq!(read, heard);
        }
    }
}
