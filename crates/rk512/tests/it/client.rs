//! The client: whole jobs, and every check of a reaction.

use core::time::Duration;

use rk512::{
    Area, Client, Command, Config, JobError, Outcome, Part, ReactionError, ReactionFault,
    SubmitError,
};

const NOW: Duration = Duration::from_millis(100);
const DB5: Area = Area::db(5, 0);

fn client() -> Client<256> {
    Client::new(Config::DEFAULT)
}

fn fetch(area: Area, length: u16) -> Command {
    Command::fetch(area, length).unwrap()
}

fn send(area: Area, words: u16) -> Command {
    Command::send(area, words).unwrap()
}

/// The next telegram, delivered.
fn command(client: &mut Client<256>, now: Duration) -> Vec<u8> {
    let telegram = client.poll_transmit(now).expect("a telegram");
    client.handle_delivered(now);
    telegram.to_vec()
}

fn failure(client: &mut Client<256>) -> JobError {
    match client.poll_event() {
        Some(Outcome::Failed { error, .. }) => error,
        other => panic!("{other:?} instead of a failure"),
    }
}

fn fetched(client: &mut Client<256>) -> Vec<u8> {
    match client.poll_event() {
        Some(Outcome::Fetched { data, .. }) => data.to_vec(),
        other => panic!("{other:?} instead of data"),
    }
}

/// How a FETCH of two words or a SEND of one ends with this reaction.
fn fault(job: Job, reaction: &[u8]) -> (JobError, Option<u16>) {
    let mut client = client();
    match job {
        Job::Fetch => client.submit(fetch(DB5, 2), &[]).unwrap(),
        Job::Send => client.submit(send(DB5, 1), &[1, 2]).unwrap(),
    };
    command(&mut client, NOW);
    client.handle_block(NOW, reaction);
    let error = failure(&mut client);
    assert!(!client.is_busy(), "one outcome, then the next job");
    (error, error.event())
}

enum Job {
    Fetch,
    Send,
}

#[test]
fn send_of_65_words() {
    let mut client = client();
    let data: Vec<u8> = (0..65u16).flat_map(u16::to_be_bytes).collect();
    let job = send(DB5, 65);
    client.submit(job, &data).unwrap();
    let first = command(&mut client, NOW);
    assert_eq!(first[..10], [0, 0, 0x41, 0x44, 5, 0, 0, 65, 0xFF, 0xFF]);
    assert_eq!(first[10..], data[..128]);
    client.handle_block(NOW, &[0, 0, 0, 0]);
    assert_eq!(client.poll_event(), None);
    let rest = command(&mut client, NOW);
    assert_eq!(rest, [0xFF, 0, 0x41, 0x44, 0, 64]);
    client.handle_block(NOW, &[0xFF, 0, 0, 0]);
    let sent = Outcome::Sent { command: job };
    assert_eq!(client.poll_event(), Some(sent));
    assert_eq!(client.poll_event(), None);
}

#[test]
fn fetch_of_65_words() {
    let mut client = client();
    let data: Vec<u8> = (0..65u16).flat_map(u16::to_be_bytes).collect();
    let job = fetch(DB5, 65);
    client.submit(job, &[]).unwrap();
    assert_eq!(command(&mut client, NOW).len(), 10);
    client.handle_block(NOW, &[&[0, 0, 0, 0], &data[..128]].concat());
    assert_eq!(command(&mut client, NOW), [0xFF, 0, 0x45, 0x44]);
    client.handle_block(NOW, &[0xFF, 0, 0, 0, 0, 64]);
    let fetched = Outcome::Fetched {
        command: job,
        data: &data,
    };
    assert_eq!(client.poll_event(), Some(fetched));
}

/// The events of the manual, by their numbers.
#[test]
fn e0a01_to_e0a06_wrong_reactions() {
    use ReactionFault as F;
    let (got, expected) = (Part::Continuation, Part::First);
    let out_of_step = F::OutOfStep { got, expected };
    let data_length = |len| F::DataLength { len, expected: 4 };
    for (job, reaction, wanted, event) in [
        (Job::Send, &[0xFF, 0, 0, 0][..], out_of_step, 0x0A01),
        (
            Job::Fetch,
            &[0x55, 0, 0, 0, 1, 2, 3, 4],
            F::FirstByte { value: 0x55 },
            0x0A02,
        ),
        (Job::Fetch, &[0; 4], data_length(0), 0x0A03),
        (Job::Fetch, &[0; 7], data_length(3), 0x0A03),
        (Job::Fetch, &[0; 9], data_length(5), 0x0A03),
        (
            Job::Send,
            &[0, 0, 0, 0, 9],
            F::SendWithData { len: 1 },
            0x0A04,
        ),
        (Job::Fetch, &[0; 3], F::TooShort { len: 3 }, 0x0A06),
    ] {
        let wanted = (JobError::Reaction(wanted), Some(event));
        assert_eq!(fault(job, reaction), wanted);
    }
}

#[test]
fn e0a01_the_first_reaction_once_more() {
    let mut client = client();
    client.submit(send(DB5, 65), &[0; 130]).unwrap();
    for _ in 0..2 {
        command(&mut client, NOW);
        client.handle_block(NOW, &[0, 0, 0, 0]);
    }
    let (got, expected) = (Part::First, Part::Continuation);
    let out_of_step = ReactionFault::OutOfStep { got, expected };
    assert_eq!(failure(&mut client), JobError::Reaction(out_of_step));
}

#[test]
fn e0a05_no_reaction_in_time() {
    let mut client = client();
    client.submit(fetch(DB5, 1), &[]).unwrap();
    assert!(client.poll_transmit(Duration::ZERO).is_some());
    assert_eq!(
        client.poll_timeout(),
        None,
        "the transport has its own times"
    );
    client.handle_delivered(NOW);
    let deadline = NOW + Duration::from_secs(20);
    assert_eq!(client.poll_timeout(), Some(deadline));
    client.handle_timeout(deadline - Duration::from_nanos(1));
    assert_eq!(client.poll_event(), None);
    client.handle_timeout(deadline);
    let error = failure(&mut client);
    assert_eq!(error, JobError::NoReaction(Duration::from_secs(20)));
    assert_eq!(error.event(), Some(0x0A05));
}

#[test]
fn error_numbers_reach_the_caller_raw() {
    for code in 1..=u8::MAX {
        let (error, _) = fault(Job::Fetch, &[0, 0, 0, code]);
        let JobError::Refused(refusal) = error else {
            panic!("{error}");
        };
        assert_eq!(refusal.code(), code);
    }
    let (error, _) = fault(Job::Send, &[0, 0, 0, 0x32]);
    assert_eq!(error, JobError::Refused(ReactionError::Locked));
}

#[test]
fn a_failed_job_says_how_far_it_came() {
    let mut client = client();
    let job = fetch(DB5, 65);
    client.submit(job, &[]).unwrap();
    command(&mut client, NOW);
    client.handle_block(NOW, &[0; 132]);
    assert!(client.poll_transmit(NOW).is_some());
    client.handle_failed(NOW);
    let outcome = Outcome::Failed {
        command: job,
        error: JobError::Transport,
        done: 128,
    };
    assert_eq!(client.poll_event(), Some(outcome));
}

/// A refusal is the reaction that was due; one out of step may be that of a job before.
#[test]
fn a_refusal_keeps_the_next_job_waiting_no_longer_than_success() {
    for (reaction, waits) in [
        (&[0, 0, 0, 0x32][..], None),
        (&[0xFF, 0, 0, 0, 5, 5], Some(NOW + Duration::from_secs(2))),
    ] {
        let mut client = client();
        client.submit(fetch(DB5, 1), &[]).unwrap();
        command(&mut client, NOW);
        client.handle_block(NOW, reaction);
        failure(&mut client);
        client.submit(fetch(DB5, 1), &[]).unwrap();
        assert_eq!(client.poll_transmit(NOW).is_none(), waits.is_some());
        assert_eq!(client.poll_timeout(), waits);
    }
}

/// After a lost reaction the next job waits, and what comes meanwhile is dropped.
#[test]
fn a_late_reaction_is_not_the_next_jobs() {
    let mut client = client();
    client.submit(fetch(DB5, 1), &[]).unwrap();
    command(&mut client, NOW);
    let late = NOW + Duration::from_secs(20);
    client.handle_timeout(late);
    failure(&mut client);

    client.submit(fetch(Area::db(6, 0), 1), &[]).unwrap();
    assert!(client.poll_transmit(late).is_none());
    let resync = late + Duration::from_secs(2);
    assert_eq!(client.poll_timeout(), Some(resync));
    client.handle_block(late, &[0, 0, 0, 0, 5, 5]);
    assert_eq!((client.dropped(), client.poll_event()), (1, None));
    command(&mut client, resync);
    client.handle_block(resync, &[0, 0, 0, 0, 6, 6]);
    assert_eq!(fetched(&mut client), [6, 6]);
}

#[test]
fn a_reaction_before_the_delivery_is_older() {
    let mut client = client();
    client.submit(fetch(DB5, 1), &[]).unwrap();
    client.handle_block(NOW, &[0, 0, 0, 0, 5, 5]);
    assert!(client.poll_transmit(NOW).is_some());
    client.handle_block(NOW, &[0, 0, 0, 0, 5, 5]);
    assert_eq!((client.dropped(), client.poll_event()), (2, None));
    client.handle_delivered(NOW);
    client.handle_block(NOW, &[0, 0, 0, 0, 6, 6]);
    assert_eq!(fetched(&mut client), [6, 6]);
}

/// The documented limit, and how `quiet` closes it.
#[test]
fn a_repeated_reaction_passes_for_the_next_one_unless_quiet() {
    let later = NOW + Duration::from_secs(3);
    for (quiet, got) in [(Duration::ZERO, [5, 5]), (Duration::from_secs(3), [6, 6])] {
        let config = Config {
            quiet,
            ..Config::DEFAULT
        };
        let mut client = Client::<256>::new(config);
        client.submit(fetch(DB5, 1), &[]).unwrap();
        command(&mut client, NOW);
        client.handle_block(NOW, &[0, 0, 0, 0, 5, 5]);
        assert!(client.poll_event().is_some());
        client.submit(fetch(Area::db(6, 0), 1), &[]).unwrap();
        if client.poll_transmit(NOW).is_some() {
            client.handle_delivered(NOW);
        }
        client.handle_block(NOW, &[0, 0, 0, 0, 5, 5]);
        if client.poll_transmit(later).is_some() {
            client.handle_delivered(later);
        }
        client.handle_block(later, &[0, 0, 0, 0, 6, 6]);
        assert_eq!(fetched(&mut client), got);
    }
}

#[test]
fn a_cancelled_job_leaves_its_telegram_to_the_transport() {
    let mut client = client();
    client.submit(fetch(DB5, 1), &[]).unwrap();
    assert!(client.poll_transmit(NOW).is_some() && !client.wants_recall());
    client.cancel(NOW);
    assert!(client.wants_recall());
    assert_eq!(failure(&mut client), JobError::Cancelled);
    client.submit(fetch(Area::db(6, 0), 1), &[]).unwrap();
    assert!(client.poll_transmit(NOW).is_none(), "one block at a time");
    client.handle_delivered(NOW);
    client.handle_block(NOW, &[0, 0, 0, 0, 5, 5]);
    assert_eq!(client.dropped(), 1);
    command(&mut client, NOW + Duration::from_secs(2));
    let reaction_due = NOW + Duration::from_secs(22);
    assert_eq!(client.poll_timeout(), Some(reaction_due));
}

#[test]
fn jobs_that_are_not_taken() {
    let mut client = Client::<4>::new(Config::DEFAULT);
    let (len, capacity) = (6, 4);
    let too_long = SubmitError::TooLong { len, capacity };
    assert_eq!(client.submit(send(DB5, 3), &[0; 6]), Err(too_long));
    assert_eq!(client.submit(fetch(DB5, 3), &[]), Err(too_long));
    for len in [0, 2, 3, 5, 131_072] {
        let data = vec![0; len];
        let error = SubmitError::DataLength { len, expected: 4 };
        assert_eq!(client.submit(send(DB5, 2), &data), Err(error));
    }
    let (len, expected) = (2, 0);
    let error = SubmitError::DataLength { len, expected };
    assert_eq!(client.submit(fetch(DB5, 2), &[0; 2]), Err(error));
    client.submit(fetch(DB5, 2), &[]).unwrap();
    let busy = client.submit(fetch(DB5, 2), &[]);
    assert_eq!(busy, Err(SubmitError::Busy));
}
