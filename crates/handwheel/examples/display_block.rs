//! A text for the display, what the pendant answers, and what its wheel means.

use handwheel::{Cell, Column, LcdBlock, LcdCommand, Line, Model, Report, Text};
use handwheel::{Status, WheelQuantiser};

fn main() -> Result<(), Box<dyn core::error::Error>> {
    // READY at line 3, column 5 of the display.
    let mut block = LcdBlock::new(Model::Hbls);
    let (line, column) = (Line::new(3)?, Column::new(5)?);
    block.push(LcdCommand::Goto(Cell { line, column }))?;
    block.push(LcdCommand::Text(Text::new("READY")?))?;
    assert_eq!(block.as_bytes(), b"\x6C\x27\x33\x35\xB2\xA5\xA1\xA4\xB9");

    // What the pendant answers when its status is asked for.
    let report = Report::decode(Model::Hbls, b"0AR")?;
    let Report::Status(Status::Hbls { key, w1, w2 }) = report else {
        return Err("no status".into());
    };
    println!(
        "key {key:?}, rotary switches at {} and {}",
        w1.get(),
        w2.get()
    );

    let wheel = WheelQuantiser::new(100, 10)?; // 100 counts in 200 ms are full speed, 10 bins
    assert_eq!(wheel.speed(-57, 10_000), -5_500); // the bin around 55, in um/s of 10 mm/s
    Ok(())
}
