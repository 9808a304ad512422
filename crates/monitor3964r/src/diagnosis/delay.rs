//! How long after the question a side answers, also where the answers are taken for those to
//! later questions.

use core::time::Duration;

use proto3964r::ascii::{DLE, NAK, STX};

use crate::monitor::{Character, Side, since};

/// Characters of one side that follow each other within this time are one burst.
pub(super) const ALONE: Duration = Duration::from_millis(20);

/// An STX without any character before it for so long is no reaction to one.
const QUIET: Duration = Duration::from_millis(300);

/// The number of answers that are looked at, the last ones: more would show nothing else, and take
/// time.
const LAST: usize = 128;

/// The number of answers and questions that are tried for a delay.
const ANSWERS: usize = 16;
const QUESTIONS: usize = 12;

/// So many STX at the same time after a NAK are no accident.
const REPEATS: usize = 3;

/// The delay of one side's answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Delay {
    pub(super) delay: Duration,
    /// How many of the answers it explains.
    pub(super) explained: usize,
    /// How many of them to the millisecond.
    exactly: usize,
    pub(super) answers: usize,
    /// How many of them come after the next STX of the other side, and how long after the question
    /// that came at most: at all, and where nothing else was heard.
    pub(super) overtaken: usize,
    pub(super) until_again: Duration,
    pub(super) waited: Duration,
    /// STX after silence, and how many of them it answers.
    first: usize,
    first_answered: usize,
}

impl Delay {
    /// What is explained to the millisecond counts three times.
    const fn score(&self) -> usize {
        self.explained + 2 * self.exactly
    }

    /// The same delay more exactly, or the shorter one, unless that leaves the STX after silence
    /// without an answer.
    fn is_better_than(&self, other: &Self) -> bool {
        if self.delay.abs_diff(other.delay) <= tolerance(self.delay) {
            self.exactly > other.exactly
        } else if self.delay < other.delay {
            !other.is_clearly_first(self)
        } else {
            self.is_clearly_first(other)
        }
    }

    /// Answers half of the STX after silence, of which the other answers next to none.
    const fn is_clearly_first(&self, other: &Self) -> bool {
        self.first_answered * 2 >= self.first
            && other.first_answered * 5 <= other.first
            && self.first > 0
    }
}

/// The delay at which most DLE of `by` follow a question of the other side, and half of them at
/// least; among such as explain as many the smallest, unless only a longer one answers the STX
/// after silence. Never above `limit`.
pub(super) fn delay_of(record: &[Character], by: Side, limit: Duration) -> Option<Delay> {
    let begin = answers(record, by).rev().nth(LAST).map_or(0, |(at, _)| at);
    let record = record.get(begin..).unwrap_or_default();
    let most = candidates(record, by, limit)
        .map(|tried| tried.score())
        .max()?;
    let good = candidates(record, by, limit)
        .filter(|tried| tried.score() == most && tried.explained * 2 >= tried.answers);
    good.reduce(|best, tried| {
        if tried.is_better_than(&best) {
            tried
        } else {
            best
        }
    })
}

/// From each of the first answers back to the questions before it.
fn candidates(record: &[Character], by: Side, limit: Duration) -> impl Iterator<Item = Delay> {
    answers(record, by)
        .take(ANSWERS)
        .flat_map(move |(at, answer)| {
            let before = record.get(..at).unwrap_or_default();
            let questions = before.iter().enumerate().rev();
            questions
                .filter(move |&(at, _)| is_question(record, at, by.other()))
                .take(QUESTIONS)
                .map(move |(_, question)| since(question.at, answer.at))
                .take_while(move |&delay| delay <= limit)
                .map(move |delay| judge(record, by, delay))
        })
}

/// How long `side` waits for an answer: the shortest time between two STX of it with nothing
/// between them.
pub(super) fn patience_of(record: &[Character], side: Side) -> Option<Duration> {
    let waits = record.windows(2).enumerate().filter_map(|(at, pair)| {
        let [first, second] = pair else { return None };
        let goes_on = is_request(record, at)
            && [first.side, second.side] == [side; 2]
            && second.intact() == Some(STX);
        goes_on.then(|| since(first.at, second.at))
    });
    waits.filter(|&wait| wait > ALONE).min()
}

/// How long after the NAK of the other side most STX of `by` come, if they are no fewer than three.
pub(super) fn repeats_of(record: &[Character], by: Side) -> Option<Duration> {
    let all = after_resets(record, by).count();
    let is_rule = |&delay: &Duration| {
        let near = after_resets(record, by).filter(|it| it.abs_diff(delay) <= tolerance(delay));
        let near = near.count();
        near >= REPEATS && near * 2 >= all
    };
    after_resets(record, by).take(ANSWERS).find(is_rule)
}

/// The time from a NAK of the other side to the next STX of this one.
fn after_resets(record: &[Character], by: Side) -> impl Iterator<Item = Duration> {
    let mut reset = None;
    record.iter().filter_map(move |heard| {
        match (heard.side == by, heard.intact()) {
            (false, Some(NAK)) => reset = Some(heard.at),
            (true, Some(STX)) => return reset.take().map(|at| since(at, heard.at)),
            _ => {}
        }
        None
    })
}

/// Stations look at their line in steps, and taps have their latency.
pub(super) fn tolerance(delay: Duration) -> Duration {
    Duration::from_millis(3).saturating_add(delay / 100)
}

fn judge(record: &[Character], by: Side, delay: Duration) -> Delay {
    let shortest = since(tolerance(delay), delay);
    let longest = delay.saturating_add(tolerance(delay));
    let mut tried = Delay {
        delay,
        explained: 0,
        exactly: 0,
        overtaken: 0,
        until_again: Duration::ZERO,
        waited: Duration::ZERO,
        answers: 0,
        first: 0,
        first_answered: 0,
    };
    for (at, answer) in answers(record, by) {
        tried.answers += 1;
        let asked = within(
            record,
            since(longest, answer.at),
            since(shortest, answer.at),
        );
        let asked = asked.filter(|&at| is_question(record, at, by.other()));
        let nearest = asked.filter_map(|at| Some((at, since(record.get(at)?.at, answer.at))));
        let Some((question, took)) = nearest.min_by_key(|(_, took)| took.abs_diff(delay)) else {
            continue;
        };
        tried.explained += 1;
        tried.exactly += usize::from(took.abs_diff(delay) <= Duration::from_millis(1));
        let until = record.get(question..at).unwrap_or_default();
        let mut between = until.iter().enumerate().skip(1);
        let again = between.find(|&(after, heard)| {
            heard.intact() == Some(STX) && is_question(record, question + after, by.other())
        });
        if let (Some(first), Some((after, again))) = (until.first(), again) {
            tried.overtaken += 1;
            let until_again = since(first.at, again.at);
            tried.until_again = tried.until_again.max(until_again);
            // What comes of the other side in between ends the wait.
            if until.iter().take(after).all(|heard| heard.side != by) {
                tried.waited = tried.waited.max(until_again);
            }
        }
    }
    for (at, question) in record.iter().enumerate() {
        if question.side == by || question.intact() != Some(STX) || !is_after_silence(record, at) {
            continue;
        }
        let due = question.at.saturating_add(shortest);
        let mut answered = within(record, due, question.at.saturating_add(longest));
        tried.first += 1;
        tried.first_answered += usize::from(answered.any(|at| is_lone_dle(record, at, by)));
    }
    tried
}

/// The places of what was heard between two times, both included.
fn within(
    record: &[Character],
    from: Duration,
    to: Duration,
) -> impl Iterator<Item = usize> + use<> {
    let begin = record.partition_point(|heard| heard.at < from);
    let end = record.partition_point(|heard| heard.at <= to);
    begin..end
}

fn answers(record: &[Character], by: Side) -> impl DoubleEndedIterator<Item = (usize, &Character)> {
    let all = record.iter().enumerate();
    all.filter(move |&(at, _)| is_lone_dle(record, at, by))
}

/// Whether these two follow each other within one burst of a side.
fn is_burst(earlier: &Character, later: &Character) -> bool {
    earlier.side == later.side && since(earlier.at, later.at) <= ALONE
}

fn is_preceded(record: &[Character], at: usize) -> bool {
    match (before(record, at), record.get(at)) {
        (Some(before), Some(heard)) => is_burst(before, heard),
        _ => false,
    }
}

fn is_followed(record: &[Character], at: usize) -> bool {
    match (record.get(at), record.get(at.saturating_add(1))) {
        (Some(heard), Some(after)) => is_burst(heard, after),
        _ => false,
    }
}

fn before(record: &[Character], at: usize) -> Option<&Character> {
    record.get(at.checked_sub(1)?)
}

fn is_lone_dle(record: &[Character], at: usize, by: Side) -> bool {
    let heard = record.get(at);
    heard.is_some_and(|heard| heard.side == by && heard.intact() == Some(DLE))
        && !is_followed(record, at)
        && !is_preceded(record, at)
}

/// STX, or the end of a block.
fn is_question(record: &[Character], at: usize, side: Side) -> bool {
    let Some(heard) = record.get(at).filter(|heard| heard.side == side) else {
        return false;
    };
    let is_end = heard.byte != NAK && is_preceded(record, at);
    (is_request(record, at) || is_end) && !is_followed(record, at)
}

/// STX that stands alone or just after a NAK.
fn is_request(record: &[Character], at: usize) -> bool {
    record.get(at).and_then(|heard| heard.intact()) == Some(STX)
        && (!is_preceded(record, at) || before(record, at).is_some_and(|last| last.byte == NAK))
}

/// Whether nothing comes just before it, and it repeats no STX.
fn is_after_silence(record: &[Character], at: usize) -> bool {
    match (before(record, at), record.get(at)) {
        (Some(before), Some(heard)) => {
            let repeats = before.side == heard.side && before.intact() == Some(STX);
            !repeats && since(before.at, heard.at) >= QUIET
        }
        _ => true,
    }
}
