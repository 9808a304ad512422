//! Sends one telegram through a serial port and prints what happens on the line.

use core::{error::Error, time::Duration};
use proto3964r::{Config, Line, Priority, serialport::Driver};

fn main() -> Result<(), Box<dyn Error>> {
    let port = serialport::new("/dev/ttyUSB0", 9600)
        .parity(serialport::Parity::Even)
        .open()?;
    let config = Config::siemens_3964r(Priority::High, Line::buffered(9600, 11));
    let mut line = Driver::<128>::new(port, config)?;
    line.submit(b"tare")?;
    while let Some(event) = line.wait(Duration::from_secs(20))? {
        println!("{event:02X?}");
    }
    Ok(())
}
