#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(any(test, feature = "std"))]
extern crate std;

mod area;
mod client;
mod command;
mod config;
mod coordination;
mod endpoint;
mod memory;
mod message;
mod reaction;
mod server;
mod source;
mod telegram;

pub use area::{Area, AreaError, AreaKind};
pub use client::{Client, JobError, Outcome, SubmitError};
pub use command::{Command, CommandError, Continuation, Request, RequestError};
pub use config::Config;
pub use coordination::{Coordination, CoordinationError, CoordinationFlag, Cpu};
pub use endpoint::{Endpoint, Event};
pub use memory::{DataBlock, Memory};
pub use message::{DecodeError, Message};
pub use reaction::{Reaction, ReactionError, ReactionFault};
pub use server::{AbandonCause, Server, ServerEvent};
pub use source::DataSource;
pub use telegram::{EncodeError, MAX_DATA, MAX_TELEGRAM, Part, Telegram};
