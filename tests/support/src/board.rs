//! Pins and a clock that log what is done to them.

use alloc::rc::Rc;
use core::{cell::RefCell, convert::Infallible, fmt};

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, OutputPin};

/// All pins and the clock of a test: `name+`, `name-`, and waits in nanoseconds.
#[derive(Clone, Debug, Default)]
pub struct Board(Rc<RefCell<Vec<String>>>);

impl Board {
    /// A pin of that name.
    #[must_use]
    pub fn pin(&self, name: &'static str) -> Pin {
        let board = self.clone();
        Pin { name, board }
    }

    fn log(&self, entry: impl fmt::Display) {
        self.0.borrow_mut().push(entry.to_string());
    }

    /// What has been done since the last call.
    #[expect(clippy::must_use_candidate, reason = "it also clears the log")]
    pub fn take(&self) -> String {
        self.0.borrow_mut().split_off(0).join(" ")
    }
}

impl DelayNs for Board {
    fn delay_ns(&mut self, ns: u32) {
        self.log(ns);
    }
}

/// A pin of a [`Board`].
#[derive(Clone, Debug)]
pub struct Pin {
    name: &'static str,
    board: Board,
}

impl Pin {
    /// Logs something else than a level.
    pub fn log(&self, entry: impl fmt::Display) {
        self.board.log(entry);
    }
}

impl ErrorType for Pin {
    type Error = Infallible;
}

impl OutputPin for Pin {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.board.log(format_args!("{}-", self.name));
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.board.log(format_args!("{}+", self.name));
        Ok(())
    }
}
