//! The kinds of fault, each with what a verdict must say of it.

mod frames;

use core::time::Duration;

use monitor3964r::{Character, Diagnosis, Formula, Verdict, diagnose};
use proto3964r::{Check, Config, Line, Priority};

pub(crate) use self::frames::{
    another_parity_of_the_tap, another_rate, another_rate_of_the_tap, no_parity, odd_parity,
    the_ratio_of_a_rate,
};
use crate::verdicts::case::{Case, Plan, between, other, pick};

/// A line of a kind: what the tap hears, and which verdicts are right.
pub(crate) struct Example {
    pub(crate) record: Vec<Character>,
    pub(crate) is_right: Box<dyn Fn(&Diagnosis) -> bool>,
    /// What the monitor expects.
    check: Check,
}

/// What says whether a verdict is right.
trait Rule: Fn(&Diagnosis) -> bool + 'static {}

impl<R: Fn(&Diagnosis) -> bool + 'static> Rule for R {}

impl Example {
    fn new(case: &Case, plans: [Plan; 2], is_right: impl Rule) -> Self {
        Self::of(case.record(plans, false), is_right)
    }

    fn of(record: Vec<Character>, is_right: impl Rule) -> Self {
        Self {
            record,
            is_right: Box::new(is_right),
            check: Check::Bcc,
        }
    }

    pub(crate) fn diagnosis(&self) -> Diagnosis {
        let preset = match self.check {
            Check::Bcc => Config::siemens_3964r,
            Check::None => Config::siemens_3964,
        };
        let config = preset(Priority::Low, Line::paced(9600, 11));
        diagnose(&self.record, &config)
    }
}

/// This verdict, also as the second cause.
fn names(found: &Diagnosis, is_it: impl Fn(Verdict) -> bool) -> bool {
    [Some(found.verdict), found.or]
        .into_iter()
        .flatten()
        .any(is_it)
}

/// Telegrams get through, whatever had to be repeated.
const fn works(verdict: Verdict, is_noisy: bool) -> bool {
    match verdict {
        Verdict::Works => true,
        Verdict::WorksWithRepeats { .. } => is_noisy,
        _ => false,
    }
}

pub(crate) fn nothing_is_wrong(case: Case) -> Example {
    let [mut faulty, partner] = case.plans();
    let jobs = faulty.jobs.len() + partner.jobs.len();
    faulty.settings.config.nak_at_startup = case.random().happens(0.5);
    Example::new(&case, [faulty, partner], move |found| {
        // One may be under way at the end.
        let telegrams = usize::try_from(found.a.telegrams + found.b.telegrams).unwrap();
        let all = case.variation.is_cut || telegrams + 4 >= jobs || case.longest > 48;
        all && works(found.verdict, case.variation.is_noisy)
    })
}

/// More noise than light.
pub(crate) fn noise(case: Case) -> Example {
    let case = Case {
        seconds: 60,
        ..case
    };
    let mut random = case.random();
    let per_million = between(&mut random, 10, 400);
    let plans = case.plans().map(|mut plan| {
        plan.faults.bit_error_rate = f64::from(u32::try_from(per_million).unwrap()) * 1e-6;
        plan
    });
    Example::new(&case, plans, |found| {
        works(found.verdict, true) || matches!(found.verdict, Verdict::BadBlocks { .. })
    })
}

/// The wire from one side alone is disturbed, so that it repeats much.
pub(crate) fn a_noisy_wire(case: Case) -> Example {
    let case = Case {
        sends: [true, case.sends[1]],
        longest: case.longest.max(12),
        ..case
    };
    let [mut faulty, partner] = case.plans();
    faulty.faults.bit_error_rate = 8e-3 / f64::from(u32::try_from(case.longest).unwrap());
    Example::new(&case, [faulty, partner], |found| {
        works(found.verdict, true) || matches!(found.verdict, Verdict::BadBlocks { .. })
    })
}

pub(crate) fn an_open_wire(case: Case) -> Example {
    let [mut faulty, partner] = case.plans();
    faulty.faults.is_deaf = true;
    let not_heard = Verdict::NotHeard {
        speaker: other(case.faulty),
        listener: case.faulty,
    };
    Example::new(&case, [faulty, partner], move |found| {
        let or = |verdict| found.or == Some(verdict);
        if case.sends[0] {
            // Without a hint of who hears whom, in step from the start, two that insist look alike.
            found.verdict == not_heard
                || matches!(found.verdict, Verdict::SamePriority { .. })
                    && (or(not_heard) || or(Verdict::NeitherHears))
        } else {
            // Its NAK of start-up may be cut off: then it may be dead as well.
            let silent = case.faulty;
            found.verdict == Verdict::NoAnswer { silent }
                && (or(not_heard) || case.variation.is_cut && found.or.is_none())
        }
    })
}

pub(crate) fn both_wires_open(case: Case) -> Example {
    let case = Case {
        sends: [true, true],
        seconds: 60,
        ..case
    };
    let plans = case.plans().map(|mut plan| {
        plan.faults.is_deaf = true;
        plan
    });
    Example::new(&case, plans, |found| {
        names(found, |verdict| verdict == Verdict::NeitherHears)
    })
}

pub(crate) fn a_dead_side(case: Case) -> Example {
    let case = Case {
        sends: [case.sends[0], true],
        seconds: 30,
        ..case
    };
    let mut random = case.random();
    let [mut faulty, mut partner] = case.plans();
    faulty.dead_from_ms = Some(0);
    partner.settings.config.qvz_ms = *pick(&mut random, &[2000, 1000, 550]);
    Example::new(&case, [faulty, partner], move |found| {
        let silent = case.faulty;
        found.verdict == Verdict::NoAnswer { silent }
    })
}

pub(crate) fn a_side_that_dies(case: Case) -> Example {
    let case = Case {
        sends: [case.sends[0], true],
        seconds: 30,
        ..case
    };
    let mut random = case.random();
    let [mut faulty, mut partner] = case.plans();
    faulty.dead_from_ms = Some(between(&mut random, 5000, 10_000));
    partner.settings.config.qvz_ms = *pick(&mut random, &[2000, 550]);
    Example::new(&case, [faulty, partner], move |found| match found.verdict {
        Verdict::NoLongerAnswers { silent, .. } => silent == case.faulty,
        // All that it sent is cut off.
        Verdict::NoAnswer { silent } => case.variation.is_cut && silent == case.faulty,
        _ => false,
    })
}

pub(crate) fn the_same_priority(case: Case) -> Example {
    let case = Case {
        sends: [true, true],
        seconds: 40,
        ..case
    };
    let priority = *pick(&mut case.random(), &[Priority::Low, Priority::High]);
    let [mut a, mut b] = case.plans();
    a.settings.config.priority = priority;
    b.settings.config.priority = priority;
    // Jobs that meet.
    for (one, two) in a.jobs.iter_mut().zip(&mut b.jobs) {
        two.0 = one.0;
    }
    Example::new(&case, [a, b], move |found| {
        found.verdict == Verdict::SamePriority { priority }
    })
}

pub(crate) fn without_bcc(case: Case) -> Example {
    let mut random = case.random();
    let [mut faulty, partner] = case.plans();
    let Config { priority, line, .. } = faulty.settings.config;
    faulty.settings.config = Config::siemens_3964(priority, line);
    if random.happens(0.5) {
        faulty.settings.config.qvz_ms = 2000;
    }
    faulty.faults.delay = Duration::from_millis(between(&mut random, 0, 5));
    Example::new(&case, [faulty, partner], move |found| {
        found.verdict == Verdict::WithoutBcc { side: case.faulty }
    })
}

pub(crate) fn both_without_bcc(case: Case) -> Example {
    let plans = case.plans().map(|mut plan| {
        let Config { priority, line, .. } = plan.settings.config;
        plan.settings.config = Config::siemens_3964(priority, line);
        plan
    });
    Example::new(&case, plans, |found| {
        found.verdict == Verdict::BothWithoutBcc
    })
}

pub(crate) fn another_bcc(case: Case) -> Example {
    let case = Case {
        sends: [true, case.sends[1]],
        longest: case.longest.min(12),
        ..case
    };
    let (formula, bcc_change) = *pick(
        &mut case.random(),
        &[
            (Formula::Undoubled, [0x10, 0]),
            (Formula::WithStx, [2, 2]),
            (Formula::WithoutEnd, [0x13, 0x13]),
            (Formula::StartValue { difference: 0xFF }, [0xFF, 0xFF]),
        ],
    );
    let [mut faulty, partner] = case.plans();
    for (number, (_, job)) in faulty.jobs.iter_mut().enumerate() {
        job.retain(|&byte| byte != 0x10);
        if number % 2 == 0 {
            job.extend([0x41, 0x10]);
        }
    }
    faulty.faults.bcc_change = bcc_change;
    Example::new(&case, [faulty, partner], move |found| {
        let sender = case.faulty;
        found.verdict == Verdict::OtherBcc { sender, formula }
    })
}

/// The check character is over what is sent, so that nothing but the single 10h is wrong.
pub(crate) fn undoubled_dle(case: Case) -> Example {
    let case = Case {
        sends: [true, false],
        longest: case.longest.min(48),
        ..case
    };
    let [mut faulty, partner] = case.plans();
    for (number, (_, job)) in faulty.jobs.iter_mut().enumerate() {
        job.retain(|&byte| byte != 0x10);
        if number % 3 != 0 {
            let after = [0x41, 0x03][number % 2];
            job.extend([0x10, after, 0x42, 0x43]);
        }
    }
    faulty.faults.doubles_no_dle = true;
    Example::new(
        &case,
        [faulty, partner],
        move |found| matches!(found.verdict, Verdict::NotDoubled { sender, .. } if sender == case.faulty),
    )
}

/// A check character that follows no rule that has a name, and repeats that are equal.
pub(crate) fn the_same_damage(case: Case) -> Example {
    let case = Case {
        sends: [true, case.sends[1]],
        longest: case.longest.min(12),
        ..case
    };
    let [mut faulty, partner] = case.plans();
    for (number, (_, job)) in faulty.jobs.iter_mut().enumerate() {
        job.retain(|&byte| byte != 0x10);
        job.push(u8::try_from(number).unwrap() | 0x80);
        if number % 2 == 0 {
            job.extend([0x10, 0x41]);
        }
    }
    // Right for half of the telegrams, and no difference that a rule makes for the others.
    faulty.faults.bcc_change = [0x5A, 0];
    Example::new(
        &case,
        [faulty, partner],
        move |found| matches!(found.verdict, Verdict::SameDamage { sender, .. } if sender == case.faulty),
    )
}

fn late(case: Case, delay_ms: u64, qvz_ms: u16) -> Example {
    let case = Case {
        sends: [false, true],
        seconds: 40,
        ..case
    };
    let [mut faulty, mut partner] = case.plans();
    faulty.faults.delay = Duration::from_millis(delay_ms);
    partner.settings.config.qvz_ms = qvz_ms;
    Example::new(&case, [faulty, partner], move |found| {
        let Verdict::Late { side, delay, qvz } = found.verdict else {
            return false;
        };
        side == case.faulty
            && delay.as_millis().abs_diff(delay_ms.into()) < 5
            && (qvz_ms == 2000 || qvz.as_millis().abs_diff(qvz_ms.into()) < 5)
    })
}

pub(crate) fn late_answers(case: Case) -> Example {
    late(case, between(&mut case.random(), 2050, 6000), 2000)
}

pub(crate) fn late_for_a_short_qvz(case: Case) -> Example {
    late(case, between(&mut case.random(), 600, 1500), 550)
}

/// Plain 3964, whose blocks a late answer must not make a fault of; whichever is expected.
pub(crate) fn late_answers_of_3964(case: Case) -> Example {
    let mut random = case.random();
    let case = Case {
        sends: [false, true],
        seconds: 40,
        ..case
    };
    let delay_ms = between(&mut random, 600, 1500);
    let plans = case.plans().map(|mut plan| {
        let Config { priority, line, .. } = plan.settings.config;
        plan.settings.config = Config::siemens_3964(priority, line);
        plan
    });
    let [mut faulty, partner] = plans;
    faulty.faults.delay = Duration::from_millis(delay_ms);
    let example = Example::new(&case, [faulty, partner], move |found| {
        matches!(found.verdict, Verdict::Late { side, delay, .. }
            if side == case.faulty && delay.as_millis().abs_diff(delay_ms.into()) < 5)
    });
    let check = *pick(&mut random, &[Check::Bcc, Check::None]);
    Example { check, ..example }
}

pub(crate) fn echo(case: Case) -> Example {
    let record = case.record(case.plans(), true);
    Example::of(record, |found| {
        names(found, |verdict| verdict == Verdict::Echo)
    })
}

pub(crate) fn own_echo(case: Case) -> Example {
    let case = Case {
        sends: [true, case.sends[1]],
        ..case
    };
    let [mut faulty, partner] = case.plans();
    faulty.faults.hears_itself = true;
    Example::new(&case, [faulty, partner], move |found| {
        found.verdict == Verdict::OwnEcho { side: case.faulty }
    })
}

pub(crate) fn pauses(case: Case) -> Example {
    let case = Case {
        sends: [true, case.sends[1]],
        longest: case.longest.min(12),
        ..case
    };
    let [mut faulty, partner] = case.plans();
    faulty.faults.pause = Duration::from_millis(between(&mut case.random(), 260, 600));
    Example::new(
        &case,
        [faulty, partner],
        move |found| matches!(found.verdict, Verdict::Gaps { sender, .. } if sender == case.faulty),
    )
}

pub(crate) fn no_receive_buffer(case: Case) -> Example {
    let case = Case {
        sends: [false, true],
        ..case
    };
    let [mut faulty, partner] = case.plans();
    faulty.faults.keeps_telegrams = true;
    Example::new(&case, [faulty, partner], move |found| {
        let refuser = case.faulty;
        found.verdict == Verdict::NoReceiveBuffer { refuser }
    })
}

pub(crate) fn a_bad_receiver(case: Case) -> Example {
    let case = Case {
        sends: [case.sends[0], true],
        longest: case.longest.min(48),
        ..case
    };
    let [mut faulty, partner] = case.plans();
    faulty.faults.receiver_error_rate = 0.15;
    Example::new(&case, [faulty, partner], move |found| {
        names(
            found,
            |verdict| matches!(verdict, Verdict::GoodBlocksRejected { refuser, .. } if refuser == case.faulty),
        )
    })
}

/// Each block is answered with STX; spelled out, since no station of this crate does that.
pub(crate) fn a_request_for_an_answer(case: Case) -> Example {
    let mut random = case.random();
    let (late_ms, receiver) = (between(&mut random, 2, 300), case.faulty);
    let sender = other(receiver);
    let [_, partner] = Case {
        sends: [true, true],
        ..case
    }
    .plans();
    let mut record = Vec::new();
    let mut now = Duration::ZERO;
    for (at, job) in partner.jobs {
        now = now.max(Duration::from_millis(at)) + Duration::from_millis(20);
        let mut say = |side, after_us, bytes: &[u8]| {
            for &byte in bytes {
                now += Duration::from_micros(after_us);
                let error = None;
                record.push(Character {
                    at: now,
                    side,
                    byte,
                    error,
                });
            }
        };
        let mut block = vec![0; proto3964r::frame::max_encoded_len(job.len())];
        let check = Check::Bcc;
        let len = proto3964r::frame::encode(&job, check, &mut block).unwrap();
        say(sender, 1146, &[0x02]);
        say(receiver, 2292, &[0x10]);
        say(sender, 1146, &block[..len]);
        say(receiver, late_ms * 1000, &[0x02]);
        now += Duration::from_secs(3);
    }
    Example::of(record, move |found| {
        matches!(found.verdict, Verdict::RequestForAnswer { side, delay }
            if side == receiver && delay == Duration::from_millis(late_ms))
    })
}
