//! `dance.c`: the order of the writes on the bus, and how long a tick lasts.

use pose2pulse::motor_phases::Rate;
use pose2pulse::motor_phases::{
    Accumulation, BusWrite, LatchWrites, Latches, Phases, SpeedLaw, Stepping, Wiring,
};
use pose2pulse::pattern_codec::c_header::Dialect;
use pose2pulse::pattern_codec::dance::{DataHeader, Packing, Threshold, Timing};

use super::engrave::{JITTER, bounds};
use super::simulator::{Port, Write, program_bytes, simulate};

/// Machine cycles of a tick of 1 ms.
const TICK: u64 = 1000;
const FRAME_TICKS: u32 = 20;

/// That of [Dancer].
const THRESHOLD: u16 = 600;

/// What `dance.c` counts on, its entry and exit included.
const LONGEST_HANDLER: u64 = 890;

type Frame = [i8; 8];

/// Rest, the fastest, reversals, every eighth speed, frames that come again: 32 frames.
fn frames() -> Vec<Frame> {
    let mut frames = vec![[0; 8], [127; 8], [-128; 8], [-128; 8]];
    frames.extend([[60, -60, 0, 0, 0, 0, 119, -119]; 5]);
    let sweep = (0..23_i8).map(|k| {
        let speeds =
            [0, 8, 16, 24, 32, 40, 48, 56].map(|speed: i8| speed.wrapping_add(k.wrapping_mul(11)));
        if k % 2 == 0 {
            speeds
        } else {
            speeds.map(i8::wrapping_neg)
        }
    });
    frames.extend(sweep);
    frames
}

fn header(frames: &[Frame], packing: Packing, threshold: u16) -> String {
    let timing = Timing::new(1000, FRAME_TICKS).unwrap();
    let mut text = String::new();
    let header = DataHeader {
        dialect: Dialect::Sdcc,
        packing,
        timing,
        threshold: Threshold::new(threshold).unwrap(),
        ..DataHeader::DEFAULT
    };
    header.write(frames.iter().copied(), &mut text).unwrap();
    text
}

fn play(
    frames: &[Frame],
    packing: Packing,
    threshold: u16,
    defines: &[&str],
) -> Option<Vec<Write>> {
    let text = header(frames, packing, threshold);
    simulate("dance.c", ("data.h", &text), defines)
}

/// The writes on the bus, each with its tick; tick 0 is before the timer starts.
fn predicted(frames: &[Frame], law: SpeedLaw, threshold: u16) -> Vec<(usize, BusWrite)> {
    let rate = Rate::from_hz(1000).unwrap();
    let mut motors = Accumulation::new(law, threshold, rate).unwrap().motors();
    let windings = Phases::new(Stepping::Half, Wiring::UNIPOLAR).unwrap();
    let mut phases = [windings.start(); 8];
    let start = LatchWrites::new(phases.map(|phase| Some(windings.byte(phase))));
    let mut writes: Vec<_> = start.map(|write| (0, write)).collect();
    let ticks = frames.iter().flat_map(|frame| {
        let repeated = core::iter::repeat_n(*frame, FRAME_TICKS as usize);
        repeated.enumerate().map(|(tick, frame)| (tick == 0, frame))
    });
    for (tick, (new, frame)) in (1..).zip(ticks) {
        if new {
            motors.set_speeds(frame);
        }
        let mut bytes = [None; 8];
        for ((phase, step), byte) in phases.iter_mut().zip(motors.tick()).zip(&mut bytes) {
            *phase = windings.advance(*phase, step);
            *byte = (step != 0).then(|| windings.byte(*phase));
        }
        writes.extend(LatchWrites::new(bytes).map(|write| (tick, write)));
    }
    writes
}

/// The states of the bus, and their cycles: data on P2, strobes on P1.
fn bus(trace: &[Write]) -> Vec<(u64, BusWrite)> {
    let (mut data, mut states) = (0, Vec::new());
    for write in trace {
        let strobe = match write.port {
            Port::P1 if write.value == 0 => None,
            Port::P1 => {
                assert_eq!(write.value.count_ones(), 1, "{write:?}");
                Some(write.value.trailing_zeros() as usize)
            }
            Port::P2 => {
                data = write.value;
                None
            }
            _ => continue,
        };
        states.push((write.cycle, BusWrite { data, strobe }));
    }
    // The program first lowers all strobes.
    assert_eq!(states.remove(0).1.strobe, None);
    states
}

/// The cycle in which the timer starts.
fn start(trace: &[Write]) -> u64 {
    let tcon = trace.iter().find(|write| write.port == Port::Tcon);
    tcon.unwrap().cycle
}

/// When each handler begins and ends.
fn handlers(trace: &[Write]) -> Vec<(u64, u64)> {
    let probe: Vec<&Write> = trace
        .iter()
        .filter(|write| write.port == Port::P0 && write.cycle > start(trace))
        .collect();
    let (pairs, rest) = probe.as_chunks::<2>();
    assert!(rest.is_empty());
    pairs
        .iter()
        .map(|[rise, fall]| {
            assert_eq!((rise.value, fall.value), (1, 0));
            (rise.cycle, fall.cycle)
        })
        .collect()
}

fn mean(numbers: impl Iterator<Item = u64> + Clone) -> f64 {
    numbers.clone().sum::<u64>() as f64 / numbers.count() as f64
}

/// All ticks of a trace: each begins exactly one tick after the one before, and each write of the
/// bus is the predicted one, in its tick, while the handler runs.
fn assert_plays(frames: &[Frame], packing: Packing, law: SpeedLaw, threshold: u16) {
    let law_define = match law {
        SpeedLaw::Reset => "LAW=LAW_RESET",
        SpeedLaw::CarryMagnitude => "LAW=LAW_CARRY_MAGNITUDE",
        _ => "LAW=LAW_CARRY_SIGNED",
    };
    let Some(trace) = play(frames, packing, threshold, &[law_define]) else {
        return;
    };
    let expected = predicted(frames, law, threshold);
    let measured = bus(&trace);
    let mut latches = Latches::<8>::new();
    for (&(tick, write), &(cycle, made)) in expected.iter().zip(&measured) {
        assert_eq!(made, write, "tick {tick}, cycle {cycle}");
        latches.write(made).unwrap();
    }
    assert_eq!(measured.len(), expected.len());

    let (start, handlers) = (start(&trace), handlers(&trace));
    assert_eq!(handlers.len(), frames.len() * FRAME_TICKS as usize);
    let mut lags = Vec::new();
    for (tick, &(begin, _)) in (1..).zip(&handlers) {
        lags.push(begin.checked_sub(start + tick * TICK).unwrap());
    }
    let (least, most) = bounds(&lags);
    assert!(most - least <= JITTER, "{least}..={most}");
    for (&(tick, _), &(cycle, _)) in expected.iter().zip(&measured) {
        if let Some(before) = tick.checked_sub(1) {
            let (begin, end) = handlers[before];
            assert!((begin..end).contains(&cycle), "tick {tick}, cycle {cycle}");
        }
    }
    let longest = handlers
        .iter()
        .map(|(begin, end)| end - begin)
        .max()
        .unwrap();
    assert!(longest <= LONGEST_HANDLER, "{longest}");
    println!(
        "dance.c, {}, {law:?}: {} writes as predicted, {least} to {most} cycles after the overflow, \
         handler at most {} cycles",
        packing.name(),
        measured.len(),
        longest,
    );
}

#[test]
fn raw_frames_are_played_write_by_write() {
    for law in [
        SpeedLaw::Reset,
        SpeedLaw::CarryMagnitude,
        SpeedLaw::CarrySigned,
    ] {
        assert_plays(&frames(), Packing::Raw, law, THRESHOLD);
    }
}

#[test]
fn frames_in_runs_are_played_write_by_write() {
    for packing in [Packing::Runs, Packing::MaskedRuns] {
        assert_plays(&frames(), packing, SpeedLaw::CarrySigned, THRESHOLD);
    }
}

#[test]
fn other_thresholds_are_played_write_by_write() {
    // At 255 the fastest motors step every other tick.
    assert_plays(&frames(), Packing::Raw, SpeedLaw::CarrySigned, 255);
    assert_plays(&frames(), Packing::Raw, SpeedLaw::Reset, 20_000);
}

/// Half steps of a motor: openings of its latch after the one at the start.
fn steps(trace: &[Write], motor: usize) -> usize {
    let states = bus(trace);
    let opened = states
        .iter()
        .filter(|(_, write)| write.strobe == Some(motor));
    opened.count() - 1
}

#[test]
fn wheels_turn_on_the_spot_for_500_ticks() {
    // [Dancer]: +60 and -60 for 25 frames, here of 20 ticks: 50 half steps each way.
    let wheels = [[60, -60, 0, 0, 0, 0, 0, 0]; 25];
    let Some(trace) = play(&wheels, Packing::Runs, THRESHOLD, &[]) else {
        return;
    };
    assert_eq!([0, 1, 2].map(|motor| steps(&trace, motor)), [50, 50, 0]);
    let handlers = handlers(&trace);
    let (first, last) = (handlers[0].0, handlers[499].0);
    assert!((last - first).abs_diff(499 * TICK) <= JITTER);
}

#[test]
fn the_reset_law_makes_100_of_119_steps() {
    let frames = [[119; 8]; 30];
    for (law, expected) in [("LAW=LAW_RESET", 100), ("LAW=LAW_CARRY_SIGNED", 119)] {
        let Some(trace) = play(&frames, Packing::Runs, THRESHOLD, &[law]) else {
            return;
        };
        let made = steps(&trace, 0);
        println!("dance.c, {law}: {made} half steps in 600 ticks at a speed of 119");
        assert_eq!(made, expected);
    }
}

/// Ticks begin as many cycles apart; handlers last as many.
fn tick_lengths(defines: &[&str]) -> Option<(Vec<u64>, Vec<u64>)> {
    // Eight motors in every tick's work.
    let frames = [[127, -127, 119, -119, 100, -100, 60, -60]; 10];
    let trace = play(&frames, Packing::Raw, THRESHOLD, defines)?;
    let handlers = handlers(&trace);
    let begins = handlers.windows(2).map(|pair| pair[1].0 - pair[0].0);
    let lengths = handlers.iter().map(|(begin, end)| end - begin);
    Some((begins.collect(), lengths.collect()))
}

#[test]
fn a_timer_restarted_at_the_end_of_the_handler_adds_the_handler_to_the_tick() {
    let Some((ticks, lengths)) = tick_lengths(&["RESTART=RESTART_WRITE", "RESTART_LAST"]) else {
        return;
    };
    // 1 ms, the handler, and the way to it.
    let overheads: Vec<u64> = ticks
        .iter()
        .zip(&lengths)
        .map(|(t, l)| t - TICK - l)
        .collect();
    let (least, most) = bounds(&overheads);
    assert!(most < 40 && most - least <= JITTER, "{least}..={most}");
    let mean_tick = mean(ticks.iter().copied());
    println!(
        "dance.c, restarted at the end: a tick of {mean_tick:.1} us, handler {:.1}",
        mean(lengths.iter().copied())
    );
    assert!(mean_tick > 1400.0);
}

#[test]
fn a_timer_written_at_the_start_of_the_handler_adds_the_latency_to_the_tick() {
    let Some((ticks, _)) = tick_lengths(&["RESTART=RESTART_WRITE"]) else {
        return;
    };
    let mean_tick = mean(ticks.iter().copied());
    println!("dance.c, written at entry: a tick of {mean_tick:.3} us");
    assert!((1005.0..1050.0).contains(&mean_tick));
    assert!(ticks.iter().all(|tick| tick.abs_diff(ticks[0]) <= JITTER));
}

#[test]
fn a_timer_stopped_added_to_and_started_keeps_the_tick() {
    let Some((ticks, _)) = tick_lengths(&["RESTART=RESTART_ADD"]) else {
        return;
    };
    let (count, sum) = (ticks.len(), ticks.iter().sum::<u64>());
    println!("dance.c, compensated: {count} ticks in {sum} us");
    // Not on average alone: no tick is further from its place than the first.
    let mut place = 0_i64;
    for tick in ticks {
        place += i64::try_from(tick).unwrap() - 1000;
        assert!(place.unsigned_abs() <= JITTER, "{place}");
    }
}

/// What the example `dance` leaves for the code unless told otherwise.
const CODE_BYTES: usize = 589;

#[test]
fn the_code_of_every_build_has_the_room_that_the_example_leaves() {
    let frames = frames();
    let mut most = 0;
    for law in ["LAW_RESET", "LAW_CARRY_MAGNITUDE", "LAW_CARRY_SIGNED"] {
        for packing in Packing::ALL {
            let text = header(&frames, packing, THRESHOLD);
            let define = format!("LAW={law}");
            let Some(bytes) = program_bytes("dance.c", ("data.h", &text), &[&define]) else {
                return;
            };
            let code = bytes - packing.encode(frames.iter().copied()).count();
            println!("dance.c, {}, {law}: {code} bytes of code", packing.name());
            most = most.max(code);
        }
    }
    // Another sdcc may need less or a little more.
    assert!(most.abs_diff(CODE_BYTES) <= 20, "{most}");
}
