//! A message, and its bytes in the store.

use bytes::Bytes;

/// A message and where it goes.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Message {
    /// In the store; 0 for what is not kept there.
    pub(crate) id: u64,
    /// Number of the telegram or the area that it is about, on its line.
    pub(crate) seq: Option<u64>,
    pub(crate) topic: String,
    pub(crate) payload: Bytes,
    /// What tells the one who asked which question this answers.
    pub(crate) correlation: Option<Bytes>,
    /// Whether the broker keeps it for those who come later.
    pub(crate) is_retained: bool,
}

/// In place of a length: there is none.
const NONE: u32 = u32::MAX;

/// Of the length of a topic, which has 16 bits: its number comes first.
const NUMBERED: u32 = 1 << 31;

impl Message {
    /// Bytes of what goes to the broker.
    pub(crate) fn len(&self) -> usize {
        let correlation = self.correlation.as_ref().map_or(0, Bytes::len);
        self.topic.len() + self.payload.len() + correlation
    }

    /// Lengths of topic and correlation data (4 bytes each, least first), the number if there is
    /// one (8 bytes), topic, correlation data, payload.
    pub(super) fn to_bytes(&self) -> Vec<u8> {
        let len = |bytes: &[u8]| u32::try_from(bytes.len()).unwrap_or(NONE);
        let correlation = self.correlation.as_deref();
        let mut bytes = Vec::with_capacity(16 + self.topic.len() + self.payload.len());
        let numbered = self.seq.map_or(0, |_| NUMBERED);
        bytes.extend((len(self.topic.as_bytes()) | numbered).to_le_bytes());
        bytes.extend(correlation.map_or(NONE, len).to_le_bytes());
        if let Some(seq) = self.seq {
            bytes.extend(seq.to_le_bytes());
        }
        bytes.extend_from_slice(self.topic.as_bytes());
        bytes.extend_from_slice(correlation.unwrap_or_default());
        bytes.extend_from_slice(&self.payload);
        bytes
    }

    /// `None` for what [`to_bytes`](Self::to_bytes) has not written.
    pub(super) fn from_bytes(id: u64, bytes: &[u8]) -> Option<Self> {
        let (topic_len, rest) = bytes.split_first_chunk()?;
        let (correlation_len, rest) = rest.split_first_chunk()?;
        let topic_len = u32::from_le_bytes(*topic_len);
        let (seq, rest) = if topic_len & NUMBERED == 0 {
            (None, rest)
        } else {
            let (seq, rest) = rest.split_first_chunk()?;
            (Some(u64::from_le_bytes(*seq)), rest)
        };
        let topic_len = usize::try_from(topic_len & !NUMBERED).ok()?;
        let (topic, rest) = rest.split_at_checked(topic_len)?;
        let (correlation, payload) = match u32::from_le_bytes(*correlation_len) {
            NONE => (None, rest),
            len => {
                let (correlation, rest) = rest.split_at_checked(usize::try_from(len).ok()?)?;
                (Some(Bytes::copy_from_slice(correlation)), rest)
            }
        };
        Some(Self {
            id,
            seq,
            topic: String::from_utf8(topic.to_vec()).ok()?,
            payload: Bytes::copy_from_slice(payload),
            correlation,
            is_retained: false,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read() {
        for (correlation, seq) in [
            (None, None),
            (Some(Bytes::new()), Some(u64::MAX)),
            (Some(Bytes::from_static(b"\x00\xFF")), Some(1)),
        ] {
            let message = Message {
                id: 7,
                seq,
                topic: "a/ä".to_owned(),
                payload: Bytes::from_static(b"{}"),
                correlation,
                is_retained: false,
            };
            let bytes = message.to_bytes();
            assert_eq!(Message::from_bytes(7, &bytes), Some(message));
            assert_eq!(Message::from_bytes(7, &bytes[..9]), None);
        }
    }
}
