//! Jobs for the driver, and what it reports.

use core::time::Duration;

use thiserror::Error;

use crate::command::LedState;
use crate::lcd::LcdBlock;
use crate::number::{Key, Led, Position};
use crate::report::{DecodeError, LcdAnswer, Model, RotarySwitch, Status};

/// What the driver is asked to do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Job {
    /// An LED of the HBLS.
    Led {
        /// Which; `None` for all of them.
        led: Option<Led>,
        /// What it does.
        state: LedState,
    },
    /// A display block.
    Lcd(LcdBlock),
}

/// Why a job was not done, as far as is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Failure {
    /// The transport gave the telegram up.
    #[error("the transport gave the telegram up")]
    Transport,
    /// The answer to the display block did not come.
    #[error("no answer within {0:?}")]
    #[cfg_attr(feature = "defmt", defmt(Debug2Format))]
    NoReply(Duration),
}

/// Why a job was not taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Error)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum SubmitError {
    /// The job before has not ended, or its outcome has not been polled.
    #[error("the job before has not ended, or its outcome has not been polled")]
    Busy,
    /// The block or the LED is another model's.
    #[error("the {model:?} has no such telegram")]
    Model {
        /// The model of the unit.
        model: Model,
    },
}

/// What [`Driver::poll_event`](crate::Driver::poll_event) hands out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Event {
    /// A key went down, or all are released.
    Key(Option<Key>),
    /// A rotary switch was turned.
    RotarySwitch(RotarySwitch, Position),
    /// The status, asked for at start-up, after a failure, and to see whether the unit is there.
    Status {
        /// Keys and rotary switches.
        status: Status,
        /// The unit was not known to be there before. It may have lost its display and LEDs.
        connected: bool,
    },
    /// The LED is set.
    LedDone,
    /// The unit's word on the display block. The HBAS says it in its status.
    Lcd {
        /// The word.
        answer: LcdAnswer,
        /// The HBAS's status.
        status: Option<Status>,
    },
    /// The job may not have been done. A status request follows by itself, which resets the unit;
    /// what the display shows is not known.
    Failed(Failure),
    /// The unit does not answer. Requests go on; the next [`Status`](Self::Status) reports when it
    /// is back.
    Lost,
    /// A telegram that means nothing.
    Unreadable(DecodeError),
}
