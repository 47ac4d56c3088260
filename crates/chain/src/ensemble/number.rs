//! What lanes are made of: double precision, eight numbers to a cache line, or
//! single, sixteen.

use crate::system::FLUSH;
use fearless_simd::{SimdFloatElement, f32x16, f64x8, prelude::*};
use std::fmt::Debug;
use std::ops::{Add, Mul};

#[cfg(target_arch = "x86_64")]
use fearless_simd::{Avx512, Level};

/// A floating-point number, `W` of which fill a cache line.
pub(super) trait Number<const W: usize>:
    SimdFloatElement
    + Default
    + PartialOrd
    + Add<Output = Self>
    + Mul<Output = Self>
    + Debug
    + Into<f64>
    + Send
    + Sync
    + 'static
{
    /// A chunk of them.
    type Wide<S: Simd>: SimdFloat<S, Element = Self, Array = [Self; W]>;

    /// Half the distance from 1 to the next number.
    const ROUNDING: f64;

    /// Beads behind the crest of a pulse on its way back that still move. One
    /// bead more makes what the others change ten times as small, with the
    /// strongest losses eight times: 1e-9 of a time of flight at fourteen,
    /// 7e-7 at eleven, which is below what single precision rounds.
    const FOLLOWED: usize;

    /// The nearest number.
    fn of(value: f64) -> Self;

    /// Overlaps up to this are none: they would make forces too small for
    /// normal numbers. From an overlap of the shot's own size.
    fn slightest_m(overlap_m: f64) -> Self;

    /// √d of numbers that are 0 or normal, where bits say that they are not 0.
    fn roots<S: Simd>(simd: S, d: Self::Wide<S>, positive: u64) -> Self::Wide<S>;
}

impl Number<8> for f64 {
    type Wide<S: Simd> = f64x8<S>;

    const ROUNDING: f64 = f64::EPSILON / 2.0;
    const FOLLOWED: usize = 14;

    #[inline(always)]
    fn of(value: f64) -> Self {
        value
    }

    fn slightest_m(_overlap_m: f64) -> Self {
        FLUSH
    }

    /// AVX-512 has a reciprocal root of 14 bits. A Goldschmidt step
    /// [Goldschmidt1964] makes a root of 28 bits of it and a step on the
    /// residual one of 42, 2e-13; elsewhere the hardware's root is as fast.
    #[inline(always)]
    #[cfg_attr(
        not(target_arch = "x86_64"),
        allow(unused_variables, reason = "other hardware takes roots of 0 itself")
    )]
    fn roots<S: Simd>(simd: S, d: f64x8<S>, positive: u64) -> f64x8<S> {
        match simd.level() {
            #[cfg(target_arch = "x86_64")]
            Level::Avx512(avx512) => double_roots(avx512, d.into(), positive as u8).simd_into(simd),
            _ => d.sqrt(),
        }
    }
}

impl Number<16> for f32 {
    type Wide<S: Simd> = f32x16<S>;

    const ROUNDING: f64 = f32::EPSILON as f64 / 2.0;
    const FOLLOWED: usize = 11;

    #[inline(always)]
    #[allow(clippy::cast_possible_truncation, reason = "single precision is what is asked for")]
    fn of(value: f64) -> Self {
        value as f32
    }

    /// A force of 1e-12 of the largest adds nothing to what is single.
    fn slightest_m(overlap_m: f64) -> Self {
        Self::of(1e-8 * overlap_m)
    }

    /// As in double precision; one step leaves rounding alone.
    #[inline(always)]
    #[cfg_attr(
        not(target_arch = "x86_64"),
        allow(unused_variables, reason = "other hardware takes roots of 0 itself")
    )]
    fn roots<S: Simd>(simd: S, d: f32x16<S>, positive: u64) -> f32x16<S> {
        match simd.level() {
            #[cfg(target_arch = "x86_64")]
            Level::Avx512(avx512) => {
                single_roots(avx512, d.into(), positive as u16).simd_into(simd)
            }
            _ => d.sqrt(),
        }
    }
}

#[cfg(target_arch = "x86_64")]
fearless_simd::kernel!(
    #[inline(always)]
    fn double_roots(avx512: Avx512, d: [f64; 8], positive: u8) -> [f64; 8] {
        use std::arch::x86_64::{
            _mm512_castpd_si512, _mm512_castsi512_pd, _mm512_mask_rsqrt14_pd, _mm512_set1_epi64,
            _mm512_sub_epi64,
        };
        let d: f64x8<Avx512> = d.simd_into(avx512);
        // Where d is 0 any seed will do: d times it is 0, and so is the root.
        let one = f64x8::splat(avx512, 1.0);
        let seed = _mm512_mask_rsqrt14_pd(one.into(), positive, d.into());
        // Halved by its exponent: no multiplication, of which there are many.
        let bits = _mm512_castpd_si512(seed);
        let halved = _mm512_sub_epi64(bits, _mm512_set1_epi64(1 << 52));
        let seed: f64x8<Avx512> = seed.simd_into(avx512);
        let reciprocal: f64x8<Avx512> = _mm512_castsi512_pd(halved).simd_into(avx512);
        let half = f64x8::splat(avx512, 0.5);
        let root = d * seed;
        let error = (-root).mul_add(reciprocal, half);
        let root = root.mul_add(error, root);
        let residual = (-root).mul_add(root, d);
        residual.mul_add(reciprocal, root).into()
    }
);

#[cfg(target_arch = "x86_64")]
fearless_simd::kernel!(
    #[inline(always)]
    fn single_roots(avx512: Avx512, d: [f32; 16], positive: u16) -> [f32; 16] {
        use std::arch::x86_64::{
            _mm512_castps_si512, _mm512_castsi512_ps, _mm512_mask_rsqrt14_ps, _mm512_set1_epi32,
            _mm512_sub_epi32,
        };
        let d: f32x16<Avx512> = d.simd_into(avx512);
        let one = f32x16::splat(avx512, 1.0);
        let seed = _mm512_mask_rsqrt14_ps(one.into(), positive, d.into());
        let bits = _mm512_castps_si512(seed);
        let halved = _mm512_sub_epi32(bits, _mm512_set1_epi32(1 << 23));
        let seed: f32x16<Avx512> = seed.simd_into(avx512);
        let reciprocal: f32x16<Avx512> = _mm512_castsi512_ps(halved).simd_into(avx512);
        let half = f32x16::splat(avx512, 0.5);
        let root = d * seed;
        let error = (-root).mul_add(reciprocal, half);
        root.mul_add(error, root).into()
    }
);
