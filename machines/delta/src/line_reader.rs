//! Bytes to lines, which end as on any system or terminal.

use anyhow::{Result, anyhow};

/// More of a line in bytes is not kept, so that a line without an end does not fill the memory.
const MAX_LINE: usize = 256;

/// A line that is read byte by byte.
#[derive(Debug, Default)]
pub(crate) struct LineReader {
    line: Vec<u8>,
    is_cut: bool,
    /// The byte before was a carriage return, to which a line feed may belong.
    has_returned: bool,
}

impl LineReader {
    /// Takes a byte; returns the line that it ends, or why it cannot be read.
    pub(crate) fn byte(&mut self, byte: u8) -> Option<Result<String>> {
        let has_returned = core::mem::replace(&mut self.has_returned, byte == b'\r');
        match byte {
            b'\n' if has_returned => return None,
            // A terminal ends its lines with the second alone.
            b'\n' | b'\r' => return Some(self.take()),
            _ if self.line.len() < MAX_LINE => self.line.push(byte),
            // Of a comment nothing is missed.
            _ => self.is_cut = !self.line.contains(&b'#'),
        }
        None
    }

    /// A last line that no byte has ended.
    pub(crate) fn end(&mut self) -> Option<Result<String>> {
        (!self.line.is_empty()).then(|| self.take())
    }

    fn take(&mut self) -> Result<String> {
        let line = core::mem::take(&mut self.line);
        if core::mem::take(&mut self.is_cut) {
            return Err(anyhow!("longer than {MAX_LINE} bytes"));
        }
        Ok(String::from_utf8_lossy(&line).into_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn lines(bytes: &[u8]) -> Vec<Result<String, String>> {
        let mut reader = LineReader::default();
        let mut lines: Vec<_> = bytes.iter().filter_map(|byte| reader.byte(*byte)).collect();
        lines.extend(reader.end());
        let text = |line: Result<String>| line.map_err(|error| error.to_string());
        lines.into_iter().map(text).collect()
    }

    #[test]
    fn lines_end_with_either_byte_or_both() {
        let wanted = ["a", "b", "", "c", "", "d"].map(|line| Ok(line.to_owned()));
        assert_eq!(lines(b"a\nb\n\nc\r\n\rd"), wanted);
        assert_eq!(lines(b""), []);
    }

    #[test]
    fn of_a_long_line_nothing_is_read_but_of_a_comment() {
        let long = [b"1 2 3 ".repeat(50), b"\n# ".to_vec(), b"x".repeat(400)].concat();
        let [line, comment] = &lines(&long)[..] else {
            panic!("two lines");
        };
        assert_eq!(line, &Err("longer than 256 bytes".to_owned()));
        assert!(comment.as_ref().unwrap().starts_with("# xxx"));
    }
}
