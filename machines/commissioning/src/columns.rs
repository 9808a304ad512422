//! Numbers in the columns of a CSV file.

use anyhow::{Context, Result, anyhow, ensure};
use csv::{ReaderBuilder, StringRecord, Trim};

/// The named columns of a CSV file, row by row, each with its line.
///
/// The first line names the columns, in any order and letters; a `#` before it is taken off, as
/// some firmware writes one. Other lines that begin with `#` are comments. What separates is a
/// comma, a semicolon or a tabulator, whichever the first line has.
///
/// # Errors
/// A column that there is not, and each cell that is no finite number, with line and column.
pub fn read_columns<const N: usize>(text: &str, names: [&str; N]) -> Result<Vec<(u64, [f64; N])>> {
    let text = text.trim_start_matches('\u{FEFF}');
    // Each line has an end, by which lines are counted.
    let text = format!("{}\n", text.strip_prefix('#').unwrap_or(text));
    let first = text.lines().next().unwrap_or_default();
    let separator = [b';', b'\t', b',']
        .into_iter()
        .find(|separator| first.contains(char::from(*separator)));
    let mut rows = ReaderBuilder::new()
        .delimiter(separator.unwrap_or(b','))
        .comment(Some(b'#'))
        .trim(Trim::All)
        .from_reader(text.as_bytes());
    let header = rows.headers().context("line 1")?.clone();
    let places = names.map(|name| place(&header, name));
    if let Some(missing) = names.iter().zip(places).find(|(_, place)| place.is_none()) {
        let there: Vec<_> = header.iter().collect();
        return Err(anyhow!(
            "line 1: no column {:?} among {}",
            missing.0,
            there.join(", ")
        ));
    }
    let (mut read, mut record) = (Vec::new(), StringRecord::new());
    while rows.read_record(&mut record)? {
        // A record's own position is before the comments above it.
        let line = rows.position().line() - 1;
        let mut values = [0.0; N];
        for ((value, name), place) in values
            .iter_mut()
            .zip(names)
            .zip(places.into_iter().flatten())
        {
            *value = number(&record, place).with_context(|| format!("line {line}, {name}"))?;
        }
        read.push((line, values));
    }
    Ok(read)
}

fn place(header: &StringRecord, name: &str) -> Option<usize> {
    header.iter().position(|it| it.eq_ignore_ascii_case(name))
}

fn number(record: &StringRecord, place: usize) -> Result<f64> {
    let cell = record.get(place).context("no such cell")?;
    let number: f64 = cell
        .parse()
        .map_err(|_| anyhow!("{cell:?} is not a number"))?;
    ensure!(number.is_finite(), "{cell:?} is not finite");
    Ok(number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_spreadsheets_and_firmware_are_read() {
        for text in [
            "a,B\n1,2\n3,4.5\n",
            "\u{FEFF}b;a;note\r\n2;1;\"x;y\"\r\n4.5;3;\r\n",
            "#b\ta\n# a comment\n2\t 1\n4.5\t3",
        ] {
            let rows = read_columns(text, ["a", "b"]).unwrap();
            let rows: Vec<_> = rows.into_iter().map(|(_, values)| values).collect();
            assert_eq!(rows, [[1.0, 2.0], [3.0, 4.5]], "{text}");
        }
    }

    #[test]
    fn what_is_wrong_is_said_with_its_place() {
        for (text, wanted) in [
            ("a,c\n1,2\n", "line 1: no column \"b\" among a, c"),
            ("a,b\n1,2\n# no\n1,x\n", "line 4, b: \"x\" is not a number"),
            ("a,b\n1,inf\n", "line 2, b: \"inf\" is not finite"),
            (
                "a,b\n1\n",
                "CSV error: record 1 (line: 2, byte: 4): found record with 1 fields, but the previous record has 2 fields",
            ),
            ("", "line 1: no column \"a\" among "),
        ] {
            let error = format!("{:#}", read_columns(text, ["a", "b"]).unwrap_err());
            assert_eq!(error, wanted);
        }
    }
}
