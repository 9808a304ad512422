//! What is stored as JSON comes back.

use core::fmt::Debug;

use serde::{Serialize, de::DeserializeOwned};

/// Writes a value and reads it back, which must give the same; the text between.
pub fn stored<T: Serialize + DeserializeOwned + PartialEq + Debug>(value: &T) -> String {
    let text = serde_json::to_string(value).unwrap();
    assert_eq!(&serde_json::from_str::<T>(&text).unwrap(), value, "{text}");
    text
}

/// Why a text is no value: it is not read without a word.
#[must_use]
pub fn not_read<T: DeserializeOwned>(text: &str) -> String {
    match serde_json::from_str::<T>(text) {
        Ok(_) => panic!("{text} is read"),
        Err(error) => error.to_string(),
    }
}
