//! Speed of writing and reading display blocks, and of the panel.
use core::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use handwheel::{
    Arbiter, Command, Input, Model, Panel, Screen, Settings, Shown, UnitId, WheelQuantiser,
};

fn telegrams(c: &mut Criterion) {
    let Ok(wheel) = WheelQuantiser::new(100, 10) else {
        return;
    };
    let Ok(mut panel) = Panel::new(UnitId(1), Settings::new(wheel)) else {
        return;
    };
    let mut arbiter = Arbiter::<3>::new();
    let screen = panel.screen(&arbiter, &[[0; 3]; 3]);
    let update = |screen: &Screen| {
        let mut shown = Shown::UNKNOWN;
        shown.update(black_box(screen), Model::Hbls)
    };
    c.bench_function("first display block of a screen", |b| {
        b.iter(|| update(&screen));
    });
    if let Some(block) = update(&screen) {
        c.bench_function("read a display block", |b| {
            b.iter(
                || match Command::decode(Model::Hbls, black_box(block.as_bytes())) {
                    Ok(Command::Lcd(commands)) => commands.filter(Result::is_ok).count(),
                    _ => 0,
                },
            );
        });
    }
    c.bench_function("panel: one wheel sample", |b| {
        b.iter(|| panel.handle(black_box(Input::Wheel(57)), &mut arbiter));
    });
    c.bench_function("quantise one sample", |b| {
        b.iter(|| wheel.share(black_box(57), black_box(10_000)));
    });
}

criterion_group!(benches, telegrams);
criterion_main!(benches);
