//! Memory: what is quicker by the machine's own words.
#![allow(unsafe_code)]

/// Fills 16-bit memory by the machine's own words: `slice::fill` stores one element at a time where there are no vectors.
pub(crate) fn fill(memory: &mut [u16], value: u16) {
    const AT_ONCE: usize = 32;
    // Where the value is known, the compiler would call `memset`, which is slower on small machines.
    let value = core::hint::black_box(value);
    let word = usize::MAX / 0xffff * value as usize;
    // SAFETY: every pattern of bits is a `u16` and a `usize`.
    let (head, words, tail) = unsafe { memory.align_to_mut::<usize>() };
    let (blocks, rest) = words.as_chunks_mut::<AT_ONCE>();
    head.fill(value);
    blocks.fill([word; AT_ONCE]);
    rest.fill(word);
    tail.fill(value);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_fill_what_elements_fill() {
        for (start, end) in (0..9).flat_map(|start| (start..150).map(move |end| (start, end))) {
            let (mut words, mut elements) = ([7u16; 160], [7u16; 160]);
            fill(&mut words[start..end], 0xa55b);
            elements[start..end].fill(0xa55b);
            assert_eq!(words, elements, "{start}..{end}");
        }
    }
}
