//! Serialised form of a platform: its locators, checked when they are read.

use nalgebra::RealField;
use serde::de::{Error, SeqAccess, Visitor};
use serde::ser::SerializeTuple;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::{Locator, Platform};

impl<const N: usize, T: RealField + Copy + Serialize> Serialize for Platform<N, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut tuple = serializer.serialize_tuple(N)?;
        for locator in self.locators() {
            tuple.serialize_element(locator)?;
        }
        tuple.end()
    }
}

impl<'de, const N: usize, T> Deserialize<'de> for Platform<N, T>
where
    T: RealField + Copy + core::fmt::LowerExp + Deserialize<'de>,
{
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let locators = deserializer.deserialize_tuple(N, Locators(core::marker::PhantomData))?;
        Self::new(locators).map_err(D::Error::custom)
    }
}

/// Reads exactly `N` locators.
struct Locators<const N: usize, T>(core::marker::PhantomData<T>);

impl<'de, const N: usize, T> Visitor<'de> for Locators<N, T>
where
    T: RealField + Copy + Deserialize<'de>,
{
    type Value = [Locator<T>; N];

    fn expecting(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{N} locators")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sequence: A) -> Result<Self::Value, A::Error> {
        let mut next = |number| {
            let locator = sequence.next_element()?;
            locator.ok_or_else(|| A::Error::invalid_length(number, &self))
        };
        let mut locators = [next(0)?; N];
        for (number, locator) in locators.iter_mut().enumerate().skip(1) {
            *locator = next(number)?;
        }
        Ok(locators)
    }
}
