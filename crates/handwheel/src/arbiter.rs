//! Who may move what.

use thiserror::Error;

/// A hand-held pendant; every panel at one arbiter has its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::exhaustive_structs, reason = "a name for a number")]
pub struct UnitId(pub u8);

/// What can be moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[expect(clippy::exhaustive_enums, reason = "the platform has nothing else")]
pub enum Target {
    /// One locator, counted from 0.
    Locator(u8),
    /// The body on all locators.
    Body,
}

/// Why a unit may not move something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Refused {
    /// Another unit moves it, or something that it hangs on.
    #[error("unit {} moves {target:?}", owner.0)]
    Owned {
        /// What the other moves.
        target: Target,
        /// The other.
        owner: UnitId,
    },
    /// There is no such locator.
    #[error("locator {index}, there are {locators}")]
    NoSuchLocator {
        /// The index asked for.
        index: u8,
        /// Locators.
        locators: usize,
    },
}

/// One owner at a time for each of `N` locators and for the body.
///
/// The body hangs on all locators: whoever moves it keeps the others from each of them, and
/// nobody moves the body while another moves a locator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Arbiter<const N: usize> {
    locators: [Option<UnitId>; N],
    body: Option<UnitId>,
}

impl<const N: usize> Default for Arbiter<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> Arbiter<N> {
    /// Nobody owns anything. `N` is 1 to 255.
    #[must_use]
    pub const fn new() -> Self {
        const { assert!(N > 0 && N < 256, "1 to 255 locators") }
        Self {
            locators: [None; N],
            body: None,
        }
    }

    /// Gives `target` to `unit`, which may have it already.
    ///
    /// # Errors
    /// [`Refused`]; nothing has changed then.
    pub fn acquire(&mut self, target: Target, unit: UnitId) -> Result<(), Refused> {
        if let Some((target, owner)) = self.hindrance(target, unit) {
            return Err(Refused::Owned { target, owner });
        }
        match target {
            Target::Body => self.body = Some(unit),
            Target::Locator(index) => {
                let place = self.locators.get_mut(usize::from(index));
                let locators = N;
                *place.ok_or(Refused::NoSuchLocator { index, locators })? = Some(unit);
            }
        }
        Ok(())
    }

    /// Takes everything from `unit`.
    pub fn release(&mut self, unit: UnitId) {
        for owner in self.locators.iter_mut().chain([&mut self.body]) {
            if *owner == Some(unit) {
                *owner = None;
            }
        }
    }

    /// Who moves `target`: a locator's owner, or that of the body it carries.
    #[must_use]
    pub fn owner(&self, target: Target) -> Option<UnitId> {
        match target {
            Target::Body => self.body,
            Target::Locator(index) => {
                let own = self.locators.get(usize::from(index)).copied();
                own.flatten().or(self.body)
            }
        }
    }

    /// What another unit moves that keeps `unit` from `target`.
    fn hindrance(&self, target: Target, unit: UnitId) -> Option<(Target, UnitId)> {
        let others = |(target, owner): (Target, &Option<UnitId>)| {
            owner
                .filter(|&owner| owner != unit)
                .map(|owner| (target, owner))
        };
        let mut locators = (0_u8..).map(Target::Locator).zip(&self.locators);
        let body = others((Target::Body, &self.body));
        body.or_else(|| match target {
            Target::Body => locators.find_map(others),
            Target::Locator(_) => locators.find(|(it, _)| *it == target).and_then(others),
        })
    }
}
