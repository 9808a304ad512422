//! Ports of a PC by their addresses.

mod address;
mod frame;

pub use self::{
    address::{Address, AddressError, Target},
    frame::{Frame, Parity},
};
