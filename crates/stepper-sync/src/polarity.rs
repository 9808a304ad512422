//! Which level of a line acts.

/// Level at which a line does something: a winding carries current, a step pin steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "snake_case")
)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[expect(clippy::exhaustive_enums, reason = "a line has two levels")]
pub enum Polarity {
    /// At the high level.
    #[default]
    ActiveHigh,
    /// At the low level.
    ActiveLow,
}
