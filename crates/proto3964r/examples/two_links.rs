//! Two links of tokio in one program; each station works in a task of its own.

use proto3964r::{Config, Line, Priority, tokio::Link};

#[tokio::main]
async fn main() -> Result<(), Box<dyn core::error::Error>> {
    // Through a serial server, whose line is slower than TCP and takes nothing back:
    // let config = Config::siemens_3964r(Priority::High, Line::buffered(9600, 11));
    // let scale = Link::connect("tcp://192.168.0.7:4001", config).await?;
    let (here, there) = tokio::io::duplex(64);
    let plc = Link::new(here, Config::siemens_3964r(Priority::High, Line::Instant));
    let scale = Link::new(there, Config::siemens_3964r(Priority::Low, Line::Instant));
    plc.send(b"tare").await?;
    println!("{:?}", scale.receive().await?.escape_ascii().to_string());
    Ok(())
}
