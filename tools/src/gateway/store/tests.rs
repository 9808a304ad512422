mod disk;

use std::{env, time::Instant};

use bytes::Bytes;
use tempfile::TempDir;

use self::disk::{Disk, Random};
use super::*;

/// Bytes that no test here fills, where it does not want to.
const ROOM: u64 = 1 << 20;
/// Bytes of a message made here, in the store: two lengths, the topic, a number.
const MESSAGE: u64 = 8 + 1 + 4;

fn entry(seq: u32) -> Entry {
    Entry {
        message: Message {
            topic: "t".to_owned(),
            payload: Bytes::copy_from_slice(&seq.to_be_bytes()),
            ..Message::default()
        },
        number: Some(Number {
            line: "scale".to_owned(),
            seq: seq.into(),
            telegram: seq.to_be_bytes().to_vec(),
            area: Some(Box::new((
                "orders".to_owned(),
                vec![seq.to_be_bytes()[3]; 4],
            ))),
        }),
    }
}

fn open(folder: &TempDir, max_bytes: u64, overflow: Overflow) -> (Store, Known) {
    Store::open(folder.path(), max_bytes, overflow).unwrap()
}

/// Numbers of the messages, by their identifiers.
fn messages(store: &mut Store) -> Vec<(u64, u32)> {
    let messages = store.read_after(0, usize::MAX).unwrap();
    let number = |message: &Message| u32::from_be_bytes(message.payload[..].try_into().unwrap());
    messages
        .iter()
        .map(|message| (message.id, number(message)))
        .collect()
}

#[test]
fn what_was_stored_is_there_after_a_restart() {
    let folder = TempDir::new().unwrap();
    let (mut store, first) = open(&folder, ROOM, Overflow::Wait);
    assert_eq!((first.messages, first.lines.len()), (0, 0));
    let committed = store.commit(&[entry(1), entry(2), entry(3)], &[]).unwrap();
    assert_eq!(committed.stored, [Ok(1), Ok(2), Ok(3)]);
    store.commit(&[], &[2]).unwrap();
    assert!(matches!(
        Store::open(folder.path(), ROOM, Overflow::Wait),
        Err(StoreError::Disk(_))
    ));
    drop(store);

    let (mut store, known) = open(&folder, ROOM, Overflow::Wait);
    assert_eq!((&known.run, known.messages), (&first.run, 2));
    let last = &known.lines["scale"];
    assert_eq!((last.seq, &last.telegram[..]), (3, &[0, 0, 0, 3][..]));
    assert_eq!(last.areas["orders"], [3; 4]);
    assert_eq!(messages(&mut store), [(1, 1), (3, 3)]);
    assert_eq!(store.bytes(), 2 * MESSAGE);
    // An identifier is not used again, though the last one was forgotten.
    store.commit(&[], &[1, 3]).unwrap();
    drop(store);
    let (mut store, _) = open(&folder, ROOM, Overflow::Wait);
    assert_eq!((store.count(), store.bytes()), (0, 0));
    assert_eq!(store.commit(&[entry(4)], &[]).unwrap().stored, [Ok(4)]);

    let other = TempDir::new().unwrap();
    assert_ne!(open(&other, ROOM, Overflow::Wait).1.run, first.run);
}

#[test]
fn a_full_store_refuses_or_drops_the_oldest() {
    let folder = TempDir::new().unwrap();
    let (mut store, _) = open(&folder, 2 * MESSAGE, Overflow::Wait);
    let committed = store.commit(&[entry(1), entry(2), entry(3)], &[]).unwrap();
    let full = StoreError::Full {
        bytes: 2 * MESSAGE,
        max: 2 * MESSAGE,
    };
    assert_eq!(committed.stored, [Ok(1), Ok(2), Err(full)]);
    // What was not stored has no number either.
    drop(store);
    let (mut store, known) = open(&folder, 2 * MESSAGE, Overflow::DropOldest);
    assert_eq!(known.lines["scale"].seq, 2);
    let committed = store.commit(&[entry(3)], &[]).unwrap();
    assert_eq!((committed.dropped, committed.dropped_to), (1, Some(1)));
    assert_eq!(messages(&mut store), [(2, 2), (3, 3)]);
}

#[test]
fn a_disk_that_fails_is_said_and_tried_again() {
    let disk = Disk::default();
    let (mut store, _) = Store::on(disk.opener(), ROOM, Overflow::Wait).unwrap();
    store.commit(&[entry(1)], &[]).unwrap();
    disk.fail_after(1);
    assert!(matches!(
        store.commit(&[entry(2)], &[]),
        Err(StoreError::Disk(_))
    ));
    assert!(store.read_after(0, 1).is_err());
    disk.repair();
    store.commit(&[entry(3)], &[]).unwrap();
    let numbers: Vec<_> = messages(&mut store).iter().map(|&(_, seq)| seq).collect();
    // The second may be on disk: nobody was told that it is not.
    assert!(numbers == [1, 3] || numbers == [1, 2, 3], "{numbers:?}");
}

/// The power fails in the middle of commits. Of what was written since the last flush, some sectors
/// are on the disk and some are not, in any order.
#[test]
fn a_power_cut_loses_nothing_that_was_stored() {
    let cuts: u32 = env::var("STORE_CUTS").map_or(150, |cuts| cuts.parse().unwrap());
    let mut random = Random(0x9E37_79B9);
    let mut disk = Disk::default();
    let (mut stored, mut maybe, mut forgotten) = (Vec::new(), Vec::new(), Vec::new());
    let (mut next, mut in_the_middle) = (1, 0);
    for _ in 0..cuts {
        let (mut store, known) = Store::on(disk.opener(), ROOM, Overflow::Wait).unwrap();
        // All that was promised is there; what was not may be.
        let there = messages(&mut store);
        let missing = |seq: &&u32| !there.iter().any(|(_, there)| there == *seq);
        let lost: Vec<_> = stored.iter().filter(missing).collect();
        assert!(lost.is_empty(), "{lost:?}");
        let mut sorted = there.clone();
        sorted.sort_unstable();
        sorted.dedup_by_key(|(_, seq)| *seq);
        assert_eq!(there, sorted, "in order, once each");
        let may_be =
            |seq: &u32| stored.contains(seq) || maybe.contains(seq) || forgotten.contains(seq);
        assert!(there.iter().all(|(_, seq)| may_be(seq)));
        let last = known.lines.get("scale").map_or(0, |last| last.seq);
        assert!(last >= stored.last().copied().unwrap_or_default().into());
        stored = there.iter().map(|&(_, seq)| seq).collect();
        (maybe, forgotten) = (Vec::new(), Vec::new());

        disk.fail_after(random.below(120));
        loop {
            let entries: Vec<_> = (next..=next + random.below(3)).map(entry).collect();
            next += u32::try_from(entries.len()).unwrap();
            let seqs = entries
                .iter()
                .map(|entry| u32::try_from(entry.number.as_ref().unwrap().seq).unwrap());
            let seqs: Vec<_> = seqs.collect();
            let forget: Vec<_> = there.iter().filter(|_| random.below(8) == 0).collect();
            let ids: Vec<_> = forget.iter().map(|(id, _)| *id).collect();
            for (_, seq) in forget {
                forgotten.push(*seq);
                stored.retain(|stored| stored != seq);
            }
            match store.commit(&entries, &ids) {
                Ok(committed) => {
                    assert!(committed.stored.iter().all(Result::is_ok));
                    stored.extend(seqs);
                }
                Err(_) => {
                    maybe.extend(seqs);
                    break;
                }
            }
        }
        drop(store);
        in_the_middle += u32::from(disk.has_unflushed());
        disk = disk.cut(&mut random);
    }
    assert!(in_the_middle > cuts / 2, "{in_the_middle} of {cuts}");
}

/// What a commit takes: `STORE_FOLDER=/var/lib cargo test --release -p line3964r --lib
/// what_a_commit_takes -- --ignored --nocapture`
#[test]
#[ignore = "measures the disk"]
fn what_a_commit_takes() {
    const COMMITS: u32 = 500;
    let folder = match env::var_os("STORE_FOLDER") {
        Some(folder) => TempDir::new_in(folder).unwrap(),
        None => TempDir::new().unwrap(),
    };
    let (mut store, _) = open(&folder, 1 << 30, Overflow::Wait);
    let mut seq = 0;
    for together in [1, 20, 200] {
        let mut times: Vec<_> = (0..COMMITS)
            .map(|_| {
                let entries: Vec<_> = (seq..seq + together).map(telegram).collect();
                seq += together;
                let begin = Instant::now();
                let committed = store.commit(&entries, &[]).unwrap();
                let time = begin.elapsed();
                assert!(committed.stored.iter().all(Result::is_ok));
                // As the broker would have it: the store stays small.
                let done: Vec<_> = committed.stored.into_iter().flatten().collect();
                store.commit(&[], &done).unwrap();
                time
            })
            .collect();
        times.sort_unstable();
        let at = |percent: usize| times[(times.len() - 1) * percent / 100].as_secs_f64() * 1e3;
        println!(
            "{together} telegrams: {:.1} ms, 99 % within {:.1} ms, all within {:.1} ms",
            at(50),
            at(99),
            at(100)
        );
    }
}

/// One of 32 bytes with what the gateway makes of it.
fn telegram(seq: u32) -> Entry {
    let mut entry = entry(seq);
    entry.message.topic = "line3964r/hall-3/scale/telegram/weight".to_owned();
    entry.message.payload = Bytes::from(vec![b'x'; 300]);
    entry
}
