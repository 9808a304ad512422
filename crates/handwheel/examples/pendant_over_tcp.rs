//! A pendant on a serial server: a text, a lamp, and what its keys do.
//!
//! `cargo run -p handwheel --features tokio --example pendant_over_tcp -- tcp://192.168.0.8:4001`

use core::error::Error;
use std::env;

use handwheel::{Event, LcdBlock, LcdCommand, LedState, Model, Text, tokio::connect};

#[tokio::main(flavor = "current_thread")]
async fn main() -> Result<(), Box<dyn Error>> {
    let address = env::args()
        .nth(1)
        .ok_or("an address is missing: tcp://HOST:PORT")?;
    let pendant = connect(&address, Model::Hbls).await?;

    let mut block = LcdBlock::new(Model::Hbls);
    block.push(LcdCommand::Text(Text::new("READY")?))?;
    println!("display: {:?}", pendant.show(block).await?);
    pendant.set_led(None, LedState::On).await?;

    loop {
        match pendant.event().await? {
            Event::Key(Some(key)) => println!("key {}", key.get()),
            Event::Key(None) => println!("released"),
            Event::RotarySwitch(switch, position) => println!("{switch:?} at {}", position.get()),
            // Who jogs stops here.
            Event::Lost => println!("the pendant does not answer"),
            _ => {}
        }
    }
}
