use core::{iter, time::Duration};

use bytes::Bytes;
use tokio::time::timeout;

use super::{Entry, Message, Outbox};
use crate::gateway::{config::Overflow, store::DeadLetters};

fn in_memory(capacity: usize, overflow: Overflow) -> Outbox {
    let letters = DeadLetters::new("unused".into(), 0);
    Outbox::in_memory(capacity, overflow, letters).unwrap()
}

pub(super) fn message(payload: Bytes) -> Message {
    Message {
        topic: "t".to_owned(),
        payload,
        ..Message::default()
    }
}

async fn push(outbox: &Outbox, number: u8) {
    let message = message(Bytes::from(vec![number]));
    let number = None;
    outbox.push(Entry { message, number }).await.unwrap();
}

async fn next(outbox: &Outbox) -> Message {
    timeout(Duration::from_secs(1), outbox.next())
        .await
        .unwrap()
}

#[tokio::test]
async fn in_order_until_it_is_acknowledged() {
    let outbox = in_memory(4, Overflow::Wait);
    for number in 0..3 {
        push(&outbox, number).await;
    }
    let taken = [next(&outbox).await, next(&outbox).await];
    assert_eq!(outbox.len(), 3);
    outbox.done(&taken[0]);
    outbox.restore(taken.into_iter().skip(1));
    assert_eq!(outbox.len(), 2);
    assert_eq!(next(&outbox).await.payload, [1][..]);
    assert_eq!(next(&outbox).await.payload, [2][..]);
    assert!(outbox.is_empty());
}

#[tokio::test]
async fn full_it_waits_or_drops_the_oldest() {
    let outbox = in_memory(1, Overflow::Wait);
    push(&outbox, 0).await;
    assert!(
        timeout(Duration::from_millis(20), push(&outbox, 1))
            .await
            .is_err()
    );
    let taken = next(&outbox).await;
    let (second, ()) = tokio::join!(
        async {
            outbox.done(&taken);
            next(&outbox).await
        },
        push(&outbox, 2)
    );
    assert_eq!((second.payload, outbox.dropped()), ([2][..].into(), 0));

    let outbox = in_memory(2, Overflow::DropOldest);
    for number in 0..5 {
        push(&outbox, number).await;
    }
    assert_eq!((outbox.len(), outbox.dropped()), (2, 3));
    assert_eq!(next(&outbox).await.payload, [3][..]);
}

#[tokio::test]
async fn a_flood_takes_half_of_the_room() {
    let outbox = in_memory(8, Overflow::Wait);
    for _ in 0..100 {
        outbox.offer(message(Bytes::new()));
    }
    assert_eq!((outbox.len(), outbox.dropped()), (5, 95));
    push(&outbox, 1).await;
}

#[tokio::test]
async fn what_is_retained_comes_first_once_and_again_after_a_loss() {
    let outbox = in_memory(1, Overflow::Wait);
    push(&outbox, 0).await;
    outbox.retain("s".to_owned(), "offline".into());
    outbox.retain("s".to_owned(), "online".into());
    let status = next(&outbox).await;
    assert_eq!(
        (&status.payload[..], status.is_retained),
        (&b"online"[..], true)
    );
    outbox.retain("s".to_owned(), "online".into());
    assert!(!next(&outbox).await.is_retained);
    assert!(outbox.is_empty());
    outbox.restore(iter::empty());
    assert_eq!(next(&outbox).await, status);
}
