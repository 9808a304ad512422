//! Ports of a PC by their addresses.

mod address;
#[cfg(feature = "ports")]
mod echo;
mod frame;
#[cfg(feature = "ports")]
mod heard;
#[cfg(all(feature = "ports", unix))]
mod marks;
#[cfg(feature = "ports")]
mod open;
#[cfg(all(feature = "ports", unix))]
mod pty;
#[cfg(feature = "ports")]
mod stream;
#[cfg(feature = "ports")]
mod tcp;
#[cfg(feature = "ports")]
mod telnet;
#[cfg(all(feature = "ports", unix))]
mod tty;

#[cfg(feature = "ports")]
pub use self::stream::Port;
pub use self::{
    address::{Address, AddressError, Target, Wire},
    frame::{Frame, Parity},
};
