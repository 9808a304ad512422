#![doc = include_str!("../README.md")]
#![no_std]
#![cfg_attr(docsrs, feature(doc_cfg))]
#![warn(clippy::print_stdout, clippy::print_stderr)]

#[cfg(any(feature = "blocking", feature = "tokio"))]
extern crate alloc;
#[cfg(any(test, feature = "std"))]
extern crate std;

mod area;
#[cfg(feature = "blocking")]
#[cfg_attr(docsrs, doc(cfg(feature = "blocking")))]
pub mod blocking;
mod client;
mod command;
mod config;
mod coordination;
mod endpoint;
mod memory;
mod message;
mod reaction;
mod server;
#[cfg(any(feature = "blocking", feature = "tokio"))]
mod session;
mod source;
mod telegram;
#[cfg(feature = "tokio")]
#[cfg_attr(docsrs, doc(cfg(feature = "tokio")))]
pub mod tokio;

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
#[cfg(any(feature = "blocking", feature = "tokio"))]
#[cfg_attr(docsrs, doc(cfg(any(feature = "blocking", feature = "tokio"))))]
pub use session::CallError;
pub use source::DataSource;
pub use telegram::{EncodeError, MAX_DATA, MAX_TELEGRAM, Part, Telegram};
