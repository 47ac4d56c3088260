//! Square roots as fast as the instruction set allows.

use fearless_simd::{f64x8, prelude::*};

#[cfg(target_arch = "x86_64")]
use fearless_simd::{Avx512, Level};

/// √d of eight numbers that are 0 or at least 1e-150.
///
/// AVX-512 has a reciprocal root of 14 bits. A Goldschmidt step [Goldschmidt1964]
/// makes a root of 28 bits of it and a step on the residual one of 42, 2e-13;
/// elsewhere the hardware's root is as fast.
#[inline(always)]
pub(super) fn roots<S: Simd>(simd: S, d: f64x8<S>) -> f64x8<S> {
    match simd.level() {
        #[cfg(target_arch = "x86_64")]
        Level::Avx512(avx512) => refined(avx512, d.into()).simd_into(simd),
        _ => d.sqrt(),
    }
}

#[cfg(target_arch = "x86_64")]
fearless_simd::kernel!(
    #[inline(always)]
    fn refined(avx512: Avx512, d: [f64; 8]) -> [f64; 8] {
        use std::arch::x86_64::{
            _mm512_castpd_si512, _mm512_maskz_rsqrt14_pd, _mm512_test_epi64_mask,
        };
        let d: f64x8<Avx512> = d.simd_into(avx512);
        let bits = _mm512_castpd_si512(d.into());
        // Where d is 0 the seed is 0, and so is the root.
        let seed = _mm512_maskz_rsqrt14_pd(_mm512_test_epi64_mask(bits, bits), d.into());
        let seed: f64x8<Avx512> = seed.simd_into(avx512);
        let half = f64x8::splat(avx512, 0.5);
        let (root, reciprocal) = (d * seed, half * seed);
        let error = (-root).mul_add(reciprocal, half);
        let root = root.mul_add(error, root);
        let residual = (-root).mul_add(root, d);
        residual.mul_add(reciprocal, root).into()
    }
);
