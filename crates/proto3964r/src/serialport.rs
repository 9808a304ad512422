//! The blocking driver on a port of [`serialport`](https://docs.rs/serialport) 4.
//!
//! That crate does not report which characters came in damaged: parity protects only as far as the
//! operating system drops or replaces them, and the BCC has to see the rest.

use alloc::boxed::Box;
use core::time::Duration;
use std::io;

use serialport::{ClearBuffer, SerialPort};

use crate::blocking::{self, Port};

/// A station with its port; the clock is that of the system.
///
/// # Examples
/// ```no_run
/// use std::time::Duration;
/// use proto3964r::{Config, Event, Line, Priority, serialport::Driver};
///
/// fn main() -> Result<(), Box<dyn std::error::Error>> {
///     let port = serialport::new("/dev/ttyUSB0", 9600).parity(serialport::Parity::Even).open()?;
///     let config = Config::siemens_3964r(Priority::High, Line::buffered(9600, 11));
///     let mut line = Driver::<128>::new(port, config)?;
///     line.submit(b"tare")?;
///     while let Some(event) = line.wait(Duration::from_secs(20))? {
///         println!("{event:02X?}");
///     }
///     Ok(())
/// }
/// ```
pub type Driver<const N: usize, const T: usize = N> = blocking::Driver<Box<dyn SerialPort>, N, T>;

impl Port for Box<dyn SerialPort> {
    fn set_timeout(&mut self, timeout: Duration) -> io::Result<()> {
        Ok(SerialPort::set_timeout(&mut **self, timeout)?)
    }

    fn discard_input(&mut self) -> io::Result<()> {
        Ok(self.clear(ClearBuffer::Input)?)
    }

    fn discard_output(&mut self) -> io::Result<()> {
        Ok(self.clear(ClearBuffer::Output)?)
    }
}
