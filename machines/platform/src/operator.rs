//! The operator: reads the display, turns, presses.

use anyhow::{Context, Result, ensure};
use handwheel::{Key, LedState, Position, RotarySwitch, WheelQuantiser, WheelSampler};

use crate::panel::{PanelSettings, PoseChange};
use crate::pose::{Pose, changed};
use crate::settings::{STEP_UDEG, STEP_UM};
use crate::world::World;

/// The rotary switch for the direction and the one for the multiplier.
const DIRECTION: RotarySwitch = RotarySwitch::W2;
const MULTIPLIER: RotarySwitch = RotarySwitch::W1;
/// Counts of the samples of a jog, in percent of full speed: in one direction, and the same back.
const JOG_PERCENT: [i32; 24] = [
    3, 6, 12, 18, 27, 36, 44, 57, 63, 78, 85, 97, 104, 110, 93, 81, 72, 66, 48, 39, 31, 22, 14, 4,
];
/// From one act to the next.
const PAUSE_MS: u64 = 163;
/// Counts of a sample when a value is set, at most.
const HAND_COUNTS: i64 = 100;
/// How far a locator may be from its position after a jog there and back: what adding up rounds
/// off.
const BACK_MM: f64 = 1e-6;

/// Room for braking at the end of a jog.
const MARGIN: f64 = 1.25;

/// What the operator is to do.
pub(crate) struct Task {
    settings: PanelSettings,
    to: Pose,
    /// In wheel counts at x1.
    counts: [i64; 6],
    /// Where the body will be: `to` in whole steps of the pendant.
    pub(crate) reached: Pose,
}

impl Task {
    pub(crate) fn new(from: Pose, to: Pose, settings: &PanelSettings) -> Result<Self> {
        let names = ["x", "y", "z", "alpha", "beta", "gamma"];
        let mut change = PoseChange::ZERO;
        let mut counts = [0; 6];
        let PoseChange {
            translation_um,
            rotation_udeg,
        } = &mut change;
        let values = translation_um.iter_mut().chain(rotation_udeg);
        let poses = from.into_iter().zip(to).zip(names).zip(&mut counts);
        for (index, ((((from, to), name), counts), value)) in poses.zip(values).enumerate() {
            let (units, step, max) = match index {
                0..3 => (1e3, STEP_UM, settings.max_um),
                _ => (1e6, STEP_UDEG, settings.max_udeg),
            };
            let steps = ((to - from) * units / f64::from(step)).round();
            ensure!(
                steps.abs() * f64::from(step) <= f64::from(max),
                "{name}: a change by {} is more than the pendant can set, {}",
                to - from,
                f64::from(max) / units
            );
            #[expect(clippy::cast_possible_truncation, reason = "checked")]
            let whole = steps as i64;
            *counts = whole;
            *value = i32::try_from(whole * i64::from(step))?;
        }
        let mut reached = changed(from, &change);
        for (reached, (from, to)) in reached.iter_mut().zip(from.into_iter().zip(to)) {
            // A number that is a whole number of steps but for rounding stays what it is.
            let size = 1.0 + from.abs() + to.abs();
            if (*reached - to).abs() < f64::EPSILON * size * 8.0 {
                *reached = to;
            }
        }
        Ok(Self {
            settings: *settings,
            to,
            counts,
            reached,
        })
    }

    /// What the pendant's steps leave of the target.
    pub(crate) fn rounding_note(&self) -> Option<String> {
        let mut pairs = self.reached.iter().zip(&self.to);
        pairs
            .any(|(reached, to)| reached.total_cmp(to).is_ne())
            .then(|| {
                format!(
                    "the pendant sets whole um and 0.00001 deg: the body goes to {:?}",
                    self.reached
                )
            })
    }
}

/// Switches the pendant on, jogs a locator there and back, sets the pose change, runs it.
pub(crate) fn work<const N: usize>(world: &mut World<'_, N>, task: &Task) -> Result<()> {
    world.wait_ms(500)?;
    world.pendant.switch_on();
    world.wait_until("the first screen", 10, |it| {
        it.pendant.line(0).starts_with("SINGLE") && it.pendant.line(1).starts_with(">LOCATOR  1")
    })?;
    world.switches(false, false)?;
    jog(world, task)?;
    adjust(world, task)
}

/// Jogs an axis of the second locator.
fn jog<const N: usize>(world: &mut World<'_, N>, task: &Task) -> Result<()> {
    let (locator, axis) = (1, 1);
    let (min, position, max) = world
        .axis_limits(locator, axis)
        .context("no second locator")?;
    let (room, sign) = if max - position >= position - min {
        (max - position, 1)
    } else {
        (position - min, -1)
    };
    let counts = jog_counts(&task.settings.wheel, sign)?;
    let multiplier = multiplier_within(room, &counts, &task.settings);
    switch(world, MULTIPLIER, multiplier)?;
    switch(world, DIRECTION, 2)?;
    key(world, 2)?;
    key(world, 3)?;
    show(world, 0, "LOCATOR  2 IDLE")?;
    enable(world)?;
    for direction in [1, -1] {
        for counts in &counts {
            world.wheel(direction * counts)?;
        }
        world.wait_sample()?;
        world.wait_until("the jog's end", 60, |it| !it.is_moving())?;
        show(world, 0, "LOCATOR  2 IDLE")?;
    }
    world.switches(false, false)?;
    let residual_mm = world.largest_residual();
    ensure!(
        residual_mm < BACK_MM,
        "the locator is {residual_mm} mm from where it was"
    );
    key(world, 3)
}

/// The counts for a wheel, in the direction with more room.
fn jog_counts(wheel: &WheelQuantiser, sign: i32) -> Result<Vec<i32>> {
    let full = i64::from(wheel.max());
    let percent = JOG_PERCENT.iter();
    let counts = percent.map(|percent| Ok(sign * i32::try_from(i64::from(*percent) * full / 100)?));
    counts.collect()
}

/// The fastest multiplier, as the position of its rotary switch, with which the jog stays within
/// the room in mm.
fn multiplier_within(room: f64, counts: &[i32], settings: &PanelSettings) -> u8 {
    let speed = |counts: &i32| settings.wheel.speed(*counts, settings.full_jog_um_s);
    let um_s: i64 = counts.iter().map(speed).sum();
    #[expect(clippy::cast_precision_loss, reason = "mm")]
    let path_mm = um_s.unsigned_abs() as f64 / 1000.0 * WheelSampler::PERIOD.as_secs_f64() * MARGIN;
    match room {
        room if path_mm < room => 3,
        room if path_mm / 10.0 < room => 2,
        _ => 1,
    }
}

/// Sets the six values, looks whether they are right, and runs the change.
fn adjust<const N: usize>(world: &mut World<'_, N>, task: &Task) -> Result<()> {
    for _ in 0..N {
        key(world, 2)?;
    }
    key(world, 3)?;
    show(world, 0, "ADJUST")?;
    for (direction, counts) in (1..).zip(task.counts) {
        if counts != 0 {
            set(world, direction, counts)?;
        }
    }
    for (line, counts) in (1..).zip(task.counts) {
        let (step, decimals) = if line <= 3 {
            (STEP_UM, 3)
        } else {
            (STEP_UDEG, 6)
        };
        show(world, line, &number(counts * i64::from(step), decimals))?;
    }
    enable(world)?;
    key(world, 4)?;
    world.wait_until("the motion's end", 1_000_000, |it| {
        it.pendant.line(7).starts_with("DONE")
    })?;
    world.switches(false, false)?;
    show(world, 0, "IDLE")
}

/// Turns the wheel for one value, with each multiplier.
fn set<const N: usize>(world: &mut World<'_, N>, direction: u8, counts: i64) -> Result<()> {
    switch(world, DIRECTION, direction)?;
    for (multiplier, position) in [(100, 3), (10, 2), (1, 1)] {
        let mut turns = match multiplier {
            100 => counts / 100,
            _ => counts / multiplier % 10,
        };
        if turns == 0 {
            continue;
        }
        switch(world, MULTIPLIER, position)?;
        world.wait_sample()?;
        while turns != 0 {
            let sample = turns.clamp(-HAND_COUNTS, HAND_COUNTS);
            turns -= sample;
            world.wheel(i32::try_from(sample)?)?;
        }
    }
    Ok(())
}

/// Presses both switches; the LED says when they count.
fn enable<const N: usize>(world: &mut World<'_, N>) -> Result<()> {
    world.switches(true, true)?;
    world.wait_until("the LED", 10, |it| it.pendant.led() == LedState::On)
}

fn switch<const N: usize>(
    world: &mut World<'_, N>,
    switch: RotarySwitch,
    position: u8,
) -> Result<()> {
    let position = Position::new(position)?;
    if world.pendant.position(switch) != position {
        world.turn(switch, position);
        world.wait_ms(PAUSE_MS)?;
    }
    Ok(())
}

fn key<const N: usize>(world: &mut World<'_, N>, key: u8) -> Result<()> {
    world.press(Key::new(key)?);
    world.wait_ms(PAUSE_MS)?;
    world.release();
    world.wait_ms(PAUSE_MS)
}

/// Waits until a line of the display shows a text.
fn show<const N: usize>(world: &mut World<'_, N>, line: usize, text: &str) -> Result<()> {
    world.wait_until(text, 10, |it| it.pendant.line(line).contains(text))
}

/// As the display has it.
fn number(value: i64, decimals: u32) -> String {
    let unit = 10_i64.pow(decimals);
    let sign = if value < 0 { '-' } else { '+' };
    let (whole, rest) = (value.abs() / unit, value.abs() % unit);
    let width = usize::try_from(decimals).unwrap_or_default();
    format!("{sign}{whole}.{rest:0width$}")
}
