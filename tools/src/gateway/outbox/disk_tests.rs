//! An outbox on disk: what outlives it, and in which order.

use core::time::Duration;
use std::{fs, path::Path};

use serde_json::Value;
use tempfile::TempDir;
use tokio::time::timeout;

use super::{tests::message, *};

/// Above what is kept in memory.
const MANY: u32 = 3000;

fn outbox(folder: &Path, max_bytes: u64, sync: Sync) -> Outbox {
    let letters = DeadLetters::new(folder.join("letters"), max_bytes);
    let (store, _) = Store::open(folder, max_bytes, Overflow::Wait).unwrap();
    Outbox::on_disk(store, sync, letters).unwrap()
}

fn entry(number: u32) -> Entry {
    let message = message(number.to_be_bytes().to_vec().into());
    let number = None;
    Entry { message, number }
}

async fn next(outbox: &Outbox) -> (u32, Message) {
    let message = timeout(Duration::from_secs(10), outbox.next())
        .await
        .unwrap();
    let number = message.payload[..].try_into().unwrap();
    (u32::from_be_bytes(number), message)
}

#[tokio::test]
async fn more_than_fits_into_memory_in_order_over_restarts() {
    let folder = TempDir::new().unwrap();
    let first = outbox(folder.path(), 1 << 20, Sync::Group);
    let pushed = (0..MANY).map(|number| first.push(entry(number)));
    for pushed in futures_of(pushed).await {
        pushed.unwrap();
    }
    let mut taken = Vec::new();
    for number in 0..10 {
        let (next, message) = next(&first).await;
        assert_eq!(next, number);
        taken.push(message);
    }
    // Those that the broker has are forgotten, the others go back.
    first.done(&taken[0]);
    first.done(&taken[1]);
    first.restore(taken.into_iter().skip(2));
    assert_eq!(next(&first).await.0, 2);
    first.end();
    assert_eq!(first.len(), u64::from(MANY) - 2);
    drop(first);

    let second = outbox(folder.path(), 1 << 20, Sync::Each);
    assert!(!second.is_empty());
    for number in 2..MANY {
        let (next, message) = next(&second).await;
        assert_eq!(next, number);
        second.done(&message);
    }
    second.end();
    assert!(second.is_empty());
    assert_eq!((second.len(), second.bytes()), (0, 0));
}

/// All at once, as lines do.
async fn futures_of<F: Future>(futures: impl Iterator<Item = F>) -> Vec<F::Output> {
    let mut futures: Vec<_> = futures.map(Box::pin).collect();
    let mut outputs: Vec<Option<F::Output>> = futures.iter().map(|_| None).collect();
    core::future::poll_fn(|context| {
        for (future, output) in futures.iter_mut().zip(&mut outputs) {
            if output.is_none()
                && let core::task::Poll::Ready(ready) = future.as_mut().poll(context)
            {
                *output = Some(ready);
            }
        }
        if outputs.iter().all(Option::is_some) {
            core::task::Poll::Ready(())
        } else {
            core::task::Poll::Pending
        }
    })
    .await;
    outputs.into_iter().flatten().collect()
}

#[tokio::test]
async fn a_full_store_refuses_and_a_flood_takes_half() {
    let folder = TempDir::new().unwrap();
    let outbox = outbox(folder.path(), 130, Sync::Group);
    for number in 0..100 {
        outbox.offer(entry(number).message);
        // The thread has taken it.
        while outbox.bytes() == 0 {
            tokio::task::yield_now().await;
        }
    }
    let mut stored = 0;
    while outbox.push(entry(stored)).await.is_ok() {
        stored += 1;
    }
    let refused = outbox.push(entry(0)).await;
    let (bytes, max) = (130, 130);
    assert_eq!(refused, Err(StoreError::Full { bytes, max }));
    assert_eq!(outbox.len(), 10);
    assert!(outbox.dropped() >= 90, "{}", outbox.dropped());
}

#[tokio::test]
async fn what_the_broker_refuses_is_in_a_file() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("letters");
    let outbox = outbox(folder.path(), 1000, Sync::Group);
    let message = message("{\"seq\":1}".into());
    let number = None;
    outbox.push(Entry { message, number }).await.unwrap();
    let message = outbox.next().await;
    outbox.refused(message, "NotAuthorized".to_owned());
    outbox.end();
    assert_eq!(
        (outbox.len(), outbox.dead(), outbox.is_empty()),
        (0, 1, true)
    );
    let letter: Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
    assert_eq!(
        (&letter["reason"], &letter["topic"], &letter["payload"]),
        (&"NotAuthorized".into(), &"t".into(), &"{\"seq\":1}".into())
    );
}

/// The file cannot be written: the message stays in the store.
#[tokio::test]
async fn what_cannot_be_buried_waits() {
    let folder = TempDir::new().unwrap();
    fs::create_dir(folder.path().join("letters")).unwrap();
    let first = outbox(folder.path(), 1000, Sync::Group);
    first.push(entry(1)).await.unwrap();
    let (_, message) = next(&first).await;
    first.refused(message, "NotAuthorized".to_owned());
    first.end();
    assert_eq!((first.len(), first.dead(), first.is_empty()), (1, 0, false));
    drop(first);
    let second = outbox(folder.path(), 1000, Sync::Group);
    assert_eq!(next(&second).await.0, 1);
}
