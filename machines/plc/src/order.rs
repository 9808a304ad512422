//! What a side writes, and what its partner's memory must hold in the end.

use rk512::Area;

/// Bytes of the longest job and of each data block.
pub(crate) const BLOCK: usize = 512;

/// DB 1 and DX 2.
pub(crate) type Blocks = [[u8; BLOCK]; 2];

/// Data for a data block of the partner.
#[derive(Debug)]
pub(crate) struct Order {
    pub(crate) area: Area,
    pub(crate) data: Vec<u8>,
}

/// Data full of the control characters of 3964R, for DB 1 and DX 2 in turn.
pub(crate) fn orders(rounds: u8, salt: u8) -> Vec<Order> {
    let order = |round: u8| {
        let area = if round.is_multiple_of(2) {
            Area::db(1, round)
        } else {
            Area::dx(2, round)
        };
        let alphabet = [0x02, 0x03, 0x10, 0x10, 0x15, salt, round, 0x00];
        let len = 2 * (40 + usize::from(round) * 31 % 150);
        let data = alphabet.iter().cycle().skip(round.into()).step_by(3);
        Order {
            area,
            data: data.take(len).copied().collect(),
        }
    };
    (0..rounds).map(order).collect()
}

/// The memory after all orders.
pub(crate) fn expected(orders: &[Order]) -> Blocks {
    let mut blocks = [[0; BLOCK]; 2];
    for Order { area, data } in orders {
        let [db, dx] = &mut blocks;
        let block = if area.number() == 1 { db } else { dx };
        let place = block.iter_mut().skip(2 * usize::from(area.start()));
        for (to, &from) in place.zip(data) {
            *to = from;
        }
    }
    blocks
}
