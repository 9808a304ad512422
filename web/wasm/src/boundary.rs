//! The exports: inputs are written where [`input`] says, [`call`] performs, outputs are read.
#![expect(
    unsafe_code,
    reason = "exported symbols; nothing is read through a pointer here"
)]

use std::cell::RefCell;

use anyhow::{Context, Result};
use serde::de::DeserializeOwned;

use crate::answer::Answer;

/// The inputs of a call: the operation's name, its parameters as JSON, its bytes.
#[derive(Debug, Default)]
pub(crate) struct Request {
    inputs: Vec<Vec<u8>>,
}

impl Request {
    pub(crate) fn operation(&self) -> Result<&str> {
        let name = self.inputs.first().context("no operation is named")?;
        Ok(str::from_utf8(name)?)
    }

    pub(crate) fn parameters<T: DeserializeOwned>(&self) -> Result<T> {
        let json = self.inputs.get(1).context("there are no parameters")?;
        Ok(serde_json::from_slice(json)?)
    }
}

thread_local! {
    static REQUEST: RefCell<Request> = RefCell::default();
    static OUTPUTS: RefCell<Vec<Vec<u8>>> = RefCell::default();
}

/// One more input of so many bytes: where the page writes it.
#[unsafe(no_mangle)]
extern "C" fn input(length: usize) -> *mut u8 {
    REQUEST.with_borrow_mut(|request| {
        let mut bytes = vec![0; length];
        let address = bytes.as_mut_ptr();
        request.inputs.push(bytes);
        address
    })
}

/// Performs what the inputs ask for. Returns 1 and leaves JSON and bytes, or 0 and leaves a
/// message.
#[unsafe(no_mangle)]
extern "C" fn call() -> u32 {
    let request = REQUEST.take();
    let answer = crate::perform(&request).and_then(Answer::into_outputs);
    let (is_done, outputs) = match answer {
        Ok(outputs) => (1, outputs),
        Err(error) => (0, vec![format!("{error:#}").into_bytes()]),
    };
    OUTPUTS.set(outputs);
    is_done
}

/// Where an output begins; 0 where there is none.
#[unsafe(no_mangle)]
extern "C" fn output(index: usize) -> *const u8 {
    OUTPUTS.with_borrow(|outputs| {
        outputs
            .get(index)
            .map_or(core::ptr::null(), |it| it.as_ptr())
    })
}

/// Length of an output in bytes.
#[unsafe(no_mangle)]
extern "C" fn output_length(index: usize) -> usize {
    OUTPUTS.with_borrow(|outputs| outputs.get(index).map_or(0, Vec::len))
}
