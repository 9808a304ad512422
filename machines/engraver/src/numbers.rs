//! What the numbers of a machine file may be.

use anyhow::{Result, ensure};

pub(crate) fn positive(name: &str, value: f64) -> Result<()> {
    ensure!(
        value.is_finite() && value > 0.0,
        "{name} = {value} is not above zero"
    );
    Ok(())
}

pub(crate) fn finite(name: &str, value: f64) -> Result<()> {
    ensure!(value.is_finite(), "{name} = {value} is not finite");
    Ok(())
}
