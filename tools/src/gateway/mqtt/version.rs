//! Which MQTT the broker speaks.

use core::fmt;

use serde::Deserialize;

/// A version of MQTT.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
pub(crate) enum Version {
    #[serde(rename = "3.1.1")]
    Three,
    #[serde(rename = "5")]
    Five,
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Three => "MQTT 3.1.1",
            Self::Five => "MQTT 5",
        })
    }
}

/// The version of the next connection: the configured one, or the one that is found.
///
/// A broker of 3.1.1 alone may close a connection of 5 without a word. One of 5 that is starting
/// does so too, so that the silence counts only if the broker takes 3.1.1 meanwhile, and is silent
/// to 5 again.
#[derive(Debug)]
pub(super) enum Search {
    /// Configured, or spoken before: it stays.
    Known(Version),
    Unknown,
    /// 5 was closed at CONNECT: 3.1.1 is tried, without a message.
    Trying,
    /// And was taken: 5 once more.
    Confirming,
    /// 5 was refused by name, or again.
    Without5,
}

/// How an attempt to connect has ended before it was connected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Refusal {
    /// The broker says that it does not speak this version.
    Named,
    /// It closed the connection, or answered what is none of this version.
    Silent,
    /// Anything else: it was not reached, the password is wrong, it is full.
    Other,
}

impl Search {
    pub(super) fn new(configured: Option<Version>) -> Self {
        configured.map_or(Self::Unknown, Self::Known)
    }

    /// Of the next connection.
    pub(super) const fn version(&self) -> Version {
        match self {
            Self::Known(version) => *version,
            Self::Unknown | Self::Confirming => Version::Five,
            Self::Trying | Self::Without5 => Version::Three,
        }
    }

    /// Whether the next connection is only to see that it is taken.
    pub(super) const fn is_trial(&self) -> bool {
        matches!(self, Self::Trying)
    }

    /// The connection was taken.
    pub(super) fn taken(&mut self) {
        *self = match self {
            Self::Unknown | Self::Confirming => Self::Known(Version::Five),
            Self::Trying => Self::Confirming,
            Self::Without5 => Self::Without5,
            Self::Known(version) => Self::Known(*version),
        };
    }

    /// The connection was not taken.
    pub(super) fn refused(&mut self, refusal: Refusal) {
        *self = match (&self, refusal) {
            (Self::Known(version), _) => Self::Known(*version),
            (Self::Unknown | Self::Confirming, Refusal::Named)
            | (Self::Confirming, Refusal::Silent) => Self::Without5,
            (Self::Unknown, Refusal::Silent) => Self::Trying,
            _ => Self::Unknown,
        };
    }

    /// A connection that had been taken is lost: the broker may be another one by now.
    pub(super) fn lost(&mut self) {
        if matches!(self, Self::Without5) {
            *self = Self::Unknown;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn silence_counts_only_beside_an_answer() {
        let mut search = Search::new(None);
        assert_eq!(search.version(), Version::Five);
        search.refused(Refusal::Silent);
        assert!(search.is_trial() && search.version() == Version::Three);
        // A broker that is starting closes that one as well.
        search.refused(Refusal::Silent);
        assert_eq!(search.version(), Version::Five);
        search.refused(Refusal::Silent);
        search.taken();
        assert!(!search.is_trial() && search.version() == Version::Five);
        search.refused(Refusal::Silent);
        assert_eq!(search.version(), Version::Three);
        search.taken();
        assert_eq!(search.version(), Version::Three);
        search.lost();
        assert_eq!(search.version(), Version::Five);
    }

    #[test]
    fn a_broker_that_has_started_meanwhile_is_one_of_5() {
        let mut search = Search::new(None);
        search.refused(Refusal::Silent);
        search.taken();
        search.taken();
        for refusal in [Refusal::Named, Refusal::Silent, Refusal::Other] {
            search.lost();
            search.refused(refusal);
            assert_eq!(search.version(), Version::Five, "{refusal:?}");
        }
    }

    #[test]
    fn a_refusal_by_name_needs_no_trial() {
        let mut search = Search::new(None);
        search.refused(Refusal::Other);
        assert_eq!(search.version(), Version::Five);
        search.refused(Refusal::Named);
        assert!(!search.is_trial() && search.version() == Version::Three);
    }

    #[test]
    fn what_is_configured_stays() {
        for version in [Version::Three, Version::Five] {
            let mut search = Search::new(Some(version));
            search.refused(Refusal::Named);
            search.refused(Refusal::Silent);
            search.taken();
            search.lost();
            assert_eq!(search.version(), version);
            assert!(!search.is_trial());
        }
    }
}
