//! Speed of writing and reading display blocks, and of the wheel quantiser.
use core::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use handwheel::{Cell, Command, LcdBlock, LcdCommand, LcdError, Line, Model, Text, WheelQuantiser};

/// Six lines of 16 characters, as many as a block has room for.
fn block(text: &str) -> Result<LcdBlock, LcdError> {
    let mut block = LcdBlock::new(Model::Hbls);
    for line in 0..6 {
        let (Ok(line), Ok(text)) = (Line::new(line), Text::new(text)) else {
            continue;
        };
        let column = handwheel::Column::MIN;
        block.push(LcdCommand::Goto(Cell { line, column }))?;
        block.push(LcdCommand::Text(text))?;
    }
    Ok(block)
}

fn telegrams(c: &mut Criterion) {
    c.bench_function("write a display block", |b| {
        b.iter(|| block(black_box("LOCATOR  1  IDLE")));
    });
    if let Ok(block) = block("LOCATOR  1  IDLE") {
        c.bench_function("read a display block", |b| {
            b.iter(
                || match Command::decode(Model::Hbls, black_box(block.as_bytes())) {
                    Ok(Command::Lcd(commands)) => commands.filter(Result::is_ok).count(),
                    _ => 0,
                },
            );
        });
    }
    if let Ok(wheel) = WheelQuantiser::new(100, 10) {
        c.bench_function("quantise one sample", |b| {
            b.iter(|| wheel.speed(black_box(57), black_box(10_000)));
        });
    }
}

criterion_group!(benches, telegrams);
criterion_main!(benches);
