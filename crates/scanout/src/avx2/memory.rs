//! Lanes from and to memory: everything here that is not plain arithmetic.
#![allow(unsafe_code)]

use core::arch::x86_64::*;

use super::EIGHT;

/// Eight 32-bit words from an array.
#[inline]
#[target_feature(enable = "avx2")]
pub fn load(from: &[i32; EIGHT]) -> __m256i {
    // SAFETY: the array is the 32 bytes that are read; the instruction asks no alignment.
    unsafe { _mm256_loadu_si256(from.as_ptr().cast()) }
}

/// Eight 32-bit words to an array.
#[inline]
#[target_feature(enable = "avx2")]
pub fn store(to: &mut [i32; EIGHT], v: __m256i) {
    // SAFETY: the array is the 32 bytes that are written; the instruction asks no alignment.
    unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), v) }
}

/// Whether all lanes of `index` (signed) are in 0 .. `len`.
#[inline]
#[target_feature(enable = "avx2")]
pub fn all_below(index: __m256i, len: usize) -> bool {
    let len = _mm256_set1_epi32(len.min(i32::MAX as usize) as i32);
    let below = _mm256_andnot_si256(_mm256_srai_epi32(index, 31), _mm256_cmpgt_epi32(len, index));
    _mm256_movemask_epi8(below) == -1
}

/// Word `word` of eight elements of a slice; elements are whole words.
///
/// # Safety
/// All lanes of `index` are below the slice's length, as [`all_below`] tells.
#[inline]
#[target_feature(enable = "avx2")]
pub unsafe fn gather<T, const WORD: usize>(from: &[T], index: __m256i) -> __m256i {
    const {
        assert!(size_of::<T>().is_multiple_of(4) && WORD < size_of::<T>() / 4);
        assert!(align_of::<T>() >= 4);
    }
    let index = match size_of::<T>() / 4 {
        1 => index,
        2 => _mm256_slli_epi32(index, 1),
        4 => _mm256_slli_epi32(index, 2),
        5 => _mm256_add_epi32(index, _mm256_slli_epi32(index, 2)),
        n => _mm256_mullo_epi32(index, _mm256_set1_epi32(n as i32)),
    };
    // SAFETY: the element is in the slice (the caller says so) and the word in the element (asserted above). Indices are below 2^16 or
    // so, their multiples fit.
    unsafe { _mm256_i32gather_epi32::<4>(from.as_ptr().cast::<i32>().add(WORD), index) }
}

/// The three indices of eight triangles, given by their own indices.
///
/// # Safety
/// All lanes of `index` are below the slice's length, as [`all_below`] tells.
#[inline]
#[target_feature(enable = "avx2")]
pub unsafe fn gather_triangles(from: &[[u16; 3]], index: __m256i) -> [__m256i; 3] {
    let word = _mm256_add_epi32(index, _mm256_slli_epi32(index, 1));
    let at = from.as_ptr().cast::<u8>();
    // SAFETY: of each triangle's six bytes, which are in the slice (the caller says so), the first four and the last four.
    let (ab, bc) = unsafe {
        (
            _mm256_i32gather_epi32::<2>(at.cast(), word),
            _mm256_i32gather_epi32::<2>(at.add(2).cast(), word),
        )
    };
    let low = _mm256_set1_epi32(0xffff);
    [_mm256_and_si256(ab, low), _mm256_srli_epi32(ab, 16), _mm256_srli_epi32(bc, 16)]
}

/// The three indices of eight triangles that follow one another.
#[inline]
#[target_feature(enable = "avx2")]
pub fn triangles(from: &[[u16; 3]; EIGHT]) -> [__m256i; 3] {
    let at = from.as_ptr().cast::<u8>();
    // SAFETY: bytes 0 - 15, 24 - 39, 8 - 23 and 32 - 47 of the array's 48.
    let (low, high) = unsafe {
        (
            _mm256_loadu2_m128i(at.add(24).cast(), at.cast()),
            _mm256_loadu2_m128i(at.add(32).cast(), at.add(8).cast()),
        )
    };
    // Half a register holds triangles 0, 1 (or 4, 5) from its byte 0, the other 2, 3 (6, 7) from its byte 4.
    const NO: i8 = -1;
    let pick = |first: i8, second: i8, third: i8, fourth: i8| {
        let word = |at: i8| [at, at + 1, NO, NO];
        let [a, b, c, d] = [first, second, third, fourth].map(word);
        _mm256_setr_epi8(
            a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3], c[0], c[1], c[2], c[3], d[0], d[1],
            d[2], d[3], a[0], a[1], a[2], a[3], b[0], b[1], b[2], b[3], c[0], c[1], c[2], c[3],
            d[0], d[1], d[2], d[3],
        )
    };
    let ab = _mm256_shuffle_epi8(low, pick(0, 6, 2, 8));
    let ab_high = _mm256_shuffle_epi8(high, pick(4, 10, 6, 12));
    let c = _mm256_shuffle_epi8(low, pick(4, 10, 4, 10));
    let c_high = _mm256_shuffle_epi8(high, pick(8, 14, 8, 14));
    [
        _mm256_unpacklo_epi64(ab, ab_high),
        _mm256_unpackhi_epi64(ab, ab_high),
        _mm256_unpacklo_epi64(c, c_high),
    ]
}
