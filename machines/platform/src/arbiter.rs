//! Who may move what.

use thiserror::Error;

/// A hand-held pendant; every panel at one arbiter has its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[expect(clippy::exhaustive_structs, reason = "a name for a number")]
pub struct PendantId(pub u8);

/// What can be moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[expect(clippy::exhaustive_enums, reason = "the platform has nothing else")]
pub enum Target {
    /// One locator, counted from 0.
    Locator(u8),
    /// The body on all locators.
    Body,
}

/// Why a pendant may not move something.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[non_exhaustive]
pub enum Refused {
    /// Another pendant moves it, or something that it hangs on.
    #[error("pendant {} moves {target:?}", owner.0)]
    Owned {
        /// What the other moves.
        target: Target,
        /// The other.
        owner: PendantId,
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
    locators: [Option<PendantId>; N],
    body: Option<PendantId>,
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

    /// Gives `target` to `pendant`, which may have it already.
    ///
    /// # Errors
    /// [`Refused`]; nothing has changed then.
    pub fn acquire(&mut self, target: Target, pendant: PendantId) -> Result<(), Refused> {
        if let Some((target, owner)) = self.hindrance(target, pendant) {
            return Err(Refused::Owned { target, owner });
        }
        match target {
            Target::Body => self.body = Some(pendant),
            Target::Locator(index) => {
                let place = self.locators.get_mut(usize::from(index));
                let locators = N;
                *place.ok_or(Refused::NoSuchLocator { index, locators })? = Some(pendant);
            }
        }
        Ok(())
    }

    /// Takes everything from `pendant`.
    pub fn release(&mut self, pendant: PendantId) {
        for owner in self.locators.iter_mut().chain([&mut self.body]) {
            if *owner == Some(pendant) {
                *owner = None;
            }
        }
    }

    /// Who moves `target`: a locator's owner, or that of the body it carries.
    #[must_use]
    pub fn owner(&self, target: Target) -> Option<PendantId> {
        match target {
            Target::Body => self.body,
            Target::Locator(index) => {
                let own = self.locators.get(usize::from(index)).copied();
                own.flatten().or(self.body)
            }
        }
    }

    /// What another pendant moves that keeps `pendant` from `target`.
    fn hindrance(&self, target: Target, pendant: PendantId) -> Option<(Target, PendantId)> {
        let others = |(target, owner): (Target, &Option<PendantId>)| {
            owner
                .filter(|&owner| owner != pendant)
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
