//! Every course that two stations can take over a line that loses, damages or delays characters.
//!
//! The stations are the real ones. A world is the two of them, the characters in flight, what the
//! users have seen, and how many faults the line may still commit. Time is relative: worlds that
//! differ only in the time of day are one. From each world every next step is taken:
//!
//! - a user submits its job, or takes its events where the scope has a slow one;
//! - a user accepts or refuses a telegram whose answer is held, at any time or never;
//! - a station puts the next character on the line (one in flight per direction);
//! - the character that left first arrives, intact, at once or a character time after it left:
//!   both directions are equally fast, and a station sends what it has before it takes in the next
//!   character;
//! - a fault: it is lost, or arrives as another character, or a deadline passes before it arrives;
//! - a deadline that has come is handled; of two at the same time, either one first;
//! - nothing else can happen: time goes on to the next arrival or deadline, but by no more than
//!   half a character while one is in flight.
//!
//! The graph must have no cycle, so that every course ends, and each property is checked in every
//! world or at every end. (The `stateright` crate would search the same graph, but its `eventually`
//! is documented as sound only where paths neither join nor cycle, and these paths join all the
//! time; the absence of cycles, which is the livelock question, is what it cannot answer.)

mod courses;
mod present;

use alloc::{vec, vec::Vec};
use std::{collections::HashMap, println};

use super::*;
use crate::{
    ascii::{DLE, ETX, NAK, STX},
    config::{Line, Priority},
    event::Event,
};

type Small = Station<2, 1>;

/// The present of every world. What has been long before is forgotten.
const NOW: Duration = Duration::from_secs(1000);
/// Half of 11 bits at 9600 bit/s.
const HALF_CHARACTER: Duration = Duration::from_micros(573);

/// What a user knows about its job.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Seen {
    NotSubmitted,
    Open,
    Sent,
    Failed,
}

#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct World {
    stations: [Small; 2],
    /// In the order in which they left.
    in_flight: Vec<InFlight>,
    jobs: [Seen; 2],
    /// Telegrams that reached the user, at most 3 are counted.
    delivered: [u8; 2],
    faults_left: u8,
    /// A fault has made a DLE of another character.
    forged_dle: bool,
    /// In this step the slow user takes its events.
    user_1_looks: bool,
    /// Each user's telegram that was polled and has not been accepted or refused.
    undecided: [bool; 2],
}

/// A character on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
struct InFlight {
    to: usize,
    byte: u8,
    arrives_at: Duration,
}

/// What is explored.
struct Scope {
    configs: [Config; 2],
    payloads: [u8; 2],
    faults: u8,
    /// User 1 takes its events at any time or late, so that the receive buffer stays in use.
    slow_user: bool,
    /// With faults: a lost, a damaged and a late character each take one.
    damaged_to: &'static [u8],
}

/// What the exploration found.
#[derive(Debug, Default, PartialEq, Eq)]
struct Findings {
    worlds: usize,
    steps: usize,
    ends: usize,
    /// Ends in which a job failed.
    with_failure: usize,
    /// Ends in which a telegram came twice.
    with_repeat: usize,
    /// Telegrams that differ from what was sent.
    forged: usize,
    /// Jobs that were reported sent and never arrived.
    lost: usize,
}

impl World {
    fn start(scope: &Scope) -> Self {
        Self {
            stations: scope.configs.map(Small::with_buffers),
            in_flight: Vec::new(),
            jobs: [Seen::NotSubmitted; 2],
            delivered: [0; 2],
            faults_left: scope.faults,
            forged_dle: false,
            user_1_looks: false,
            undecided: [false; 2],
        }
    }

    /// All worlds that can be next.
    fn successors(&self, scope: &Scope, findings: &mut Findings) -> Vec<Self> {
        let mut next = Vec::new();
        let mut step = |change: &dyn Fn(&mut Self)| {
            let mut world = self.clone();
            change(&mut world);
            world.settle(scope, findings);
            next.push(world);
        };
        for side in 0..2 {
            if self.jobs[side] == Seen::NotSubmitted {
                step(&|world| {
                    world.jobs[side] = Seen::Open;
                    world.stations[side]
                        .submit(NOW, &[scope.payloads[side]])
                        .unwrap();
                });
            }
            if self.can_launch(side) {
                step(&|world| {
                    let byte = world.stations[side].poll_transmit_byte(NOW).unwrap();
                    world.in_flight.push(InFlight {
                        to: 1 - side,
                        byte,
                        arrives_at: NOW + scope.character(),
                    });
                });
            }
            if self.undecided[side] {
                step(&|world| world.decide(side, true));
                step(&|world| world.decide(side, false));
            }
            if self.stations[side]
                .poll_timeout()
                .is_some_and(|due| due <= NOW)
            {
                step(&|world| world.stations[side].handle_timeout(NOW));
            }
        }
        if scope.slow_user && self.stations[1].has_event() {
            step(&|world| world.user_1_looks = true);
        }
        let first = self.in_flight.first();
        let arrived = first.filter(|first| first.arrives_at <= NOW && !self.can_launch(first.to));
        if let Some(&InFlight { byte, .. }) = arrived {
            step(&|world| world.arrive(byte));
            if self.faults_left > 0 {
                step(&|world| {
                    world.in_flight.remove(0);
                    world.faults_left -= 1;
                });
                for &damaged in scope.damaged_to.iter().filter(|&&damaged| damaged != byte) {
                    step(&|world| {
                        world.faults_left -= 1;
                        world.forged_dle |= damaged == DLE;
                        world.arrive(damaged);
                    });
                }
            }
        }
        let due = self.stations.iter().filter_map(Small::poll_timeout).min();
        if due.is_some_and(|due| due <= NOW) {
            return next;
        }
        let arrival = first.map(|first| first.arrives_at.min(NOW + HALF_CHARACTER));
        let soonest = due.into_iter().chain(arrival).min();
        let can_launch = (0..2).any(|side| self.can_launch(side));
        if let Some(soonest) = soonest.filter(|&soonest| soonest > NOW && !can_launch) {
            step(&|world| world.pass(soonest));
        }
        if let Some(due) = due
            && self.faults_left > 0
            && first.is_some_and(|first| first.arrives_at < due)
        {
            step(&|world| {
                world.faults_left -= 1;
                world.pass(due);
            });
        }
        next
    }

    /// The user accepts the telegram that it has polled, or refuses it, in time or too late.
    fn decide(&mut self, side: usize, accepts: bool) {
        self.undecided[side] = false;
        let station = &mut self.stations[side];
        if !accepts {
            station.refuse(NOW);
        } else if station.accept(NOW) {
            self.delivered[side] = 3.min(self.delivered[side] + 1);
        }
    }

    /// Whether the station has something to send and its direction is free.
    fn can_launch(&self, side: usize) -> bool {
        let free = self.in_flight.iter().all(|first| first.to == side);
        free && self.stations[side]
            .clone()
            .poll_transmit_byte(NOW)
            .is_some()
    }

    /// The first character in flight arrives, as `byte`.
    fn arrive(&mut self, byte: u8) {
        let InFlight { to, .. } = self.in_flight.remove(0);
        self.stations[to].handle_byte(NOW, byte);
    }

    /// Makes `due` the present.
    fn pass(&mut self, due: Duration) {
        let time = due - NOW;
        for character in &mut self.in_flight {
            character.arrives_at -= time;
        }
        for station in &mut self.stations {
            station.leaving_at = station.leaving_at.map(|at| at.saturating_sub(time));
            for at in station.state.times_mut() {
                if *at != Duration::MAX {
                    *at = at.saturating_sub(time);
                }
            }
        }
    }

    /// The users take their events, and traces of the past that no longer matter go.
    fn settle(&mut self, scope: &Scope, findings: &mut Findings) {
        for side in 0..2 {
            if side == 1 && scope.slow_user && !core::mem::take(&mut self.user_1_looks) {
                self.stations[side].forget();
                continue;
            }
            while let Some(event) = self.stations[side].poll_event() {
                match event {
                    Event::Received(telegram) => {
                        findings.forged += usize::from(telegram != [scope.payloads[1 - side]]);
                        if scope.is_held() {
                            self.undecided[side] = true;
                        } else {
                            self.delivered[side] = 3.min(self.delivered[side] + 1);
                        }
                    }
                    Event::Sent { .. } => {
                        assert_eq!(self.jobs[side], Seen::Open);
                        self.jobs[side] = Seen::Sent;
                        // One that is held is not answered while it waits.
                        let waiting = self.stations[1 - side].holds_telegram && !scope.is_held();
                        if self.delivered[1 - side] == 0 && !waiting {
                            findings.lost += 1;
                            assert!(
                                self.forged_dle || scope.faults > 2,
                                "reported sent, not delivered: {self:?}"
                            );
                        }
                    }
                    Event::Failed(_) => {
                        assert_eq!(self.jobs[side], Seen::Open);
                        self.jobs[side] = Seen::Failed;
                    }
                    _ => {}
                }
            }
            self.stations[side].forget();
        }
    }
}

/// Visits every world; panics on a cycle or on an end that is none.
fn explore(scope: &Scope) -> Findings {
    /// On the path to the world at hand, or done with.
    #[derive(PartialEq)]
    enum Mark {
        OnPath,
        Done,
    }
    let mut findings = Findings::default();
    let start = World::start(scope);
    let mut marks = HashMap::from([(start.clone(), Mark::OnPath)]);
    let successors = start.successors(scope, &mut findings);
    let mut path = vec![(start, successors)];
    while let Some((world, successors)) = path.last_mut() {
        let Some(next) = successors.pop() else {
            marks.insert(world.clone(), Mark::Done);
            path.pop();
            continue;
        };
        findings.steps += 1;
        match marks.get(&next) {
            Some(Mark::Done) => continue,
            Some(Mark::OnPath) => panic!("a cycle: the stations go on for ever: {next:?}"),
            None => {}
        }
        let successors = next.successors(scope, &mut findings);
        if successors.is_empty() {
            findings.end(&next);
        }
        marks.insert(next.clone(), Mark::OnPath);
        path.push((next, successors));
    }
    findings.worlds = marks.len();
    findings
}

impl Findings {
    fn end(&mut self, world: &World) {
        assert!(
            world.stations.iter().all(Small::is_idle),
            "stuck: {world:?}"
        );
        assert!(
            world
                .jobs
                .iter()
                .all(|job| matches!(job, Seen::Sent | Seen::Failed)),
            "{world:?}"
        );
        self.ends += 1;
        self.with_failure += usize::from(world.jobs.contains(&Seen::Failed));
        self.with_repeat += usize::from(world.delivered.iter().any(|&count| count > 1));
    }
}

impl Scope {
    /// Time of a character.
    fn character(&self) -> Duration {
        match self.configs[0].line {
            Line::Instant => Duration::ZERO,
            _ => 2 * HALF_CHARACTER,
        }
    }

    /// Whether users answer telegrams, not the stations.
    fn is_held(&self) -> bool {
        self.configs[0].acknowledge_wait_ms > 0
    }

    /// The search with users that accept, refuse or forget.
    fn held(mut self) -> Self {
        for config in &mut self.configs {
            config.acknowledge_wait_ms = 1500;
        }
        self
    }

    /// The search on a UART.
    fn paced(mut self) -> Self {
        let character_ns = u32::try_from(2 * HALF_CHARACTER.as_nanos()).unwrap();
        for config in &mut self.configs {
            config.line = Line::Paced { character_ns };
        }
        self
    }
}
