//! How long after the question a side answers, also where the answers are taken for those to
//! later questions.

use core::time::Duration;

use crate::{
    ascii::{DLE, NAK, STX},
    monitor::{Character, Side, since},
};

/// A character stands alone, and a block has ended, if nothing of the same side comes within this
/// time.
const ALONE: Duration = Duration::from_millis(20);

/// An STX without any character before it for so long is no reaction to one.
const QUIET: Duration = Duration::from_millis(300);

/// Answers and questions that are tried for a delay.
const ANSWERS: usize = 16;
const QUESTIONS: usize = 12;

/// The delay of one side's answers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Delay {
    pub(super) delay: Duration,
    /// How many of the answers it explains.
    pub(super) explained: usize,
    pub(super) answers: usize,
    /// How many STX after silence it answers.
    first: usize,
}

/// The smallest delay at which four fifths of the DLE of `by` follow a question of the other
/// side; a longer one if it answers the first STX after silence more often. Never above `limit`.
pub(super) fn delay_of(record: &[Character], by: Side, limit: Duration) -> Option<Delay> {
    let mut best: Option<Delay> = None;
    for (at, answer) in answers(record, by).take(ANSWERS) {
        let before = record.get(..at).unwrap_or_default();
        let questions = before.iter().enumerate().rev();
        let questions = questions.filter(|&(at, _)| is_question(record, at, by.other()));
        for (_, question) in questions.take(QUESTIONS) {
            let delay = since(question.at, answer.at);
            if delay > limit {
                break;
            }
            let tried = judge(record, by, delay);
            if tried.explained * 5 < tried.answers * 4 {
                continue;
            }
            let is_better = best.is_none_or(|best| {
                if tried.delay < best.delay {
                    best.first < tried.first + 2
                } else {
                    tried.first >= best.first + 2
                }
            });
            if is_better {
                best = Some(tried);
            }
        }
    }
    best
}

/// How long `side` waits for an answer: the shortest time between two STX of it with nothing
/// between them.
pub(super) fn patience_of(record: &[Character], side: Side) -> Option<Duration> {
    let pairs = record.windows(2).filter_map(|pair| match pair {
        [first, second] => Some((first, second)),
        _ => None,
    });
    pairs
        .filter(|(first, second)| {
            [first, second]
                .iter()
                .all(|heard| heard.side == side && heard.intact() == Some(STX))
        })
        .map(|(first, second)| since(first.at, second.at))
        .filter(|&wait| wait > ALONE)
        .min()
}

fn judge(record: &[Character], by: Side, delay: Duration) -> Delay {
    // Stations look at their line in steps, and taps have their latency.
    let tolerance = Duration::from_millis(3).saturating_add(delay / 50);
    let shortest = since(tolerance, delay);
    let longest = delay.saturating_add(tolerance);
    let mut tried = Delay {
        delay,
        explained: 0,
        answers: 0,
        first: 0,
    };
    let mut total = Duration::ZERO;
    for (_, answer) in answers(record, by) {
        tried.answers += 1;
        let asked = within(
            record,
            since(longest, answer.at),
            since(shortest, answer.at),
        );
        let mut asked = asked.filter(|&at| is_question(record, at, by.other()));
        if let Some(question) = asked.next().and_then(|at| record.get(at)) {
            tried.explained += 1;
            total = total.saturating_add(since(question.at, answer.at));
        }
    }
    if let Some(mean) = u32::try_from(tried.explained)
        .ok()
        .and_then(|n| total.checked_div(n))
    {
        tried.delay = mean;
    }
    for (at, question) in record.iter().enumerate() {
        if question.side == by || question.intact() != Some(STX) || !is_after_silence(record, at) {
            continue;
        }
        let due = question.at.saturating_add(shortest);
        let mut answered = within(record, due, question.at.saturating_add(longest));
        tried.first += usize::from(answered.any(|at| is_lone_dle(record, at, by)));
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

fn answers(record: &[Character], by: Side) -> impl Iterator<Item = (usize, &Character)> {
    let all = record.iter().enumerate();
    all.filter(move |&(at, _)| is_lone_dle(record, at, by))
}

/// The next character of the same side, and the one before.
fn is_followed(record: &[Character], at: usize) -> bool {
    let Some((heard, after)) = record.get(at..).and_then(<[_]>::split_first) else {
        return false;
    };
    let near = after
        .iter()
        .take_while(|next| since(heard.at, next.at) <= ALONE);
    near.into_iter().any(|next| next.side == heard.side)
}

fn is_preceded(record: &[Character], at: usize) -> bool {
    let Some((heard, before)) = record.get(..=at).and_then(<[_]>::split_last) else {
        return false;
    };
    let near = before
        .iter()
        .rev()
        .take_while(|last| since(last.at, heard.at) <= ALONE);
    near.into_iter().any(|last| last.side == heard.side)
}

fn is_lone_dle(record: &[Character], at: usize, by: Side) -> bool {
    record
        .get(at)
        .is_some_and(|heard| heard.side == by && heard.intact() == Some(DLE))
        && !is_followed(record, at)
        && !is_preceded(record, at)
}

/// STX, or the end of a block.
fn is_question(record: &[Character], at: usize, side: Side) -> bool {
    record.get(at).is_some_and(|heard| {
        heard.side == side
            && (heard.byte == STX && !is_preceded_by_data(record, at)
                || heard.byte != NAK && is_preceded(record, at))
    }) && !is_followed(record, at)
}

/// A character just before, other than the NAK that a new STX may follow at once.
fn is_preceded_by_data(record: &[Character], at: usize) -> bool {
    is_preceded(record, at)
        && record.get(..at).is_some_and(|before| {
            let side = record.get(at).map(|heard| heard.side);
            let last = before.iter().rev().find(|last| Some(last.side) == side);
            last.is_some_and(|last| last.byte != NAK)
        })
}

fn is_after_silence(record: &[Character], at: usize) -> bool {
    match record.get(..=at).and_then(<[_]>::split_last) {
        Some((heard, before)) => before
            .last()
            .is_none_or(|last| since(last.at, heard.at) >= QUIET),
        None => false,
    }
}
