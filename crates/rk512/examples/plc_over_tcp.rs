//! Reads eight words of a data block through a serial server.

use rk512::Area;

#[tokio::main]
async fn main() -> Result<(), Box<dyn core::error::Error>> {
    let plc = rk512::tokio::connect("tcp://192.168.0.7:4001").await?;
    println!("{:02X?}", plc.fetch(Area::db(10, 0), 8).await?);
    Ok(())
}
