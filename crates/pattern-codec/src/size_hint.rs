//! Size hints of iterators that know their number of items.

/// The size hint of an iterator with `left` items: exact wherever `usize` holds it.
pub(crate) fn size_of_rest(left: u64) -> (usize, Option<usize>) {
    match usize::try_from(left) {
        Ok(left) => (left, Some(left)),
        Err(_) => (usize::MAX, None),
    }
}
