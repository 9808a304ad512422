//! A pattern as the C header that a firmware includes.

use anyhow::Result;
use pattern_codec::engraving::PatternHeader;

use crate::machine::Machine;
use crate::plan::Plan;

/// `pattern.h`: the records of a plan in the machine's format.
///
/// # Errors
/// An 8051 does not address more bytes.
pub fn header(machine: &Machine, plan: &Plan) -> Result<String> {
    let records = machine.format.records(plan.pattern());
    let records = records.map(|located| Ok(located?.record));
    let records: Vec<_> = records.collect::<Result<_>>()?;
    let mut text = String::new();
    PatternHeader::new(machine.format).write(records, &mut text)?;
    Ok(text)
}
