//! Serialised form of a platform: its locators, checked when they are read.

use core::array;

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
        let mut read: [Option<Locator<T>>; N] = [None; N];
        for (number, place) in read.iter_mut().enumerate() {
            *place = Some(
                sequence
                    .next_element()?
                    .ok_or_else(|| A::Error::invalid_length(number, &self))?,
            );
        }
        let first = read.first().copied().flatten();
        let first = first.ok_or_else(|| A::Error::invalid_length(0, &self))?;
        let mut read = read.into_iter().flatten();
        Ok(array::from_fn(|_| read.next().unwrap_or(first)))
    }
}
