//! Sums of laws that the loop runs in one go.
//!
//! Any section of a chain runs through [`super::section`]; the sums listed in
//! [`fuse`] run faster, because nothing is stored between one law and the
//! next. A law needs no line here.

use super::column::{Column, WIDTH};
use super::section::{Place, Sweep};
use super::touch::{Sides, Touch};
use crate::instruction_set::InstructionSet;
use crate::laws::{Closed, DampingCubic, DampingViscoelastic, ElasticHertz, Term};
use fearless_simd::{dispatch, f64x8, prelude::*};
use std::marker::PhantomData;
use std::ops::Range;

/// Most coefficients of a fused sum.
const MOST: usize = 4;

/// A sum of terms known when compiling.
pub(super) trait Sum: Send + Sync + 'static {
    /// Coefficients of all terms.
    const COEFFICIENTS: usize;

    /// The force of one lane.
    fn force(k: &[[f64; WIDTH]], lane: usize, contact: Closed) -> f64;
}

/// A sum of one.
struct One<T, const C: usize>(PhantomData<fn() -> T>);

impl<T: Term<C>, const C: usize> Sum for One<T, C> {
    const COEFFICIENTS: usize = C;

    #[inline(always)]
    fn force(k: &[[f64; WIDTH]], lane: usize, contact: Closed) -> f64 {
        let row: [f64; C] = std::array::from_fn(|j| k[j][lane]);
        T::force(&row, contact)
    }
}

impl<A: Sum, B: Sum> Sum for (A, B) {
    const COEFFICIENTS: usize = A::COEFFICIENTS + B::COEFFICIENTS;

    #[inline(always)]
    fn force(k: &[[f64; WIDTH]], lane: usize, contact: Closed) -> f64 {
        let (a, b) = k.split_at(A::COEFFICIENTS);
        A::force(a, lane, contact) + B::force(b, lane, contact)
    }
}

type Hertz = One<ElasticHertz, 1>;
type Viscoelastic = (Hertz, One<DampingViscoelastic, 1>);
type Dry = (Viscoelastic, One<DampingCubic, 1>);

/// The fast sweep over a section with these laws, in this order, if there is one.
pub(super) fn fuse(
    laws: &[&str],
    contacts: Range<usize>,
    lanes: usize,
    coefficients: Vec<Column>,
) -> Option<Box<dyn Sweep>> {
    let first = contacts.start * lanes / WIDTH;
    let section = (contacts, first, coefficients);
    Some(match laws {
        ["elastic_hertz"] => Box::new(Fused::<Hertz>::new(section)),
        ["elastic_hertz", "damping_viscoelastic"] => Box::new(Fused::<Viscoelastic>::new(section)),
        ["elastic_hertz", "damping_viscoelastic", "damping_cubic"] => {
            Box::new(Fused::<Dry>::new(section))
        }
        _ => return None,
    })
}

/// A section whose laws are a fused sum.
struct Fused<T> {
    contacts: Range<usize>,
    /// Chunk in which the section and its coefficients begin.
    first: usize,
    coefficients: Vec<Column>,
    sum: PhantomData<fn() -> T>,
}

impl<T: Sum> Fused<T> {
    fn new((contacts, first, coefficients): (Range<usize>, usize, Vec<Column>)) -> Self {
        Self {
            contacts,
            first,
            coefficients,
            sum: PhantomData,
        }
    }

    #[inline(always)]
    fn sweep<S: Simd>(&self, simd: S, place: &Place<'_>, chunks: Range<usize>, force: &mut [f64]) {
        let sides = Sides::new(
            place.offset_m,
            (chunks.end, place.lanes),
            (place.x, place.v),
            place.starting,
        );
        let force = force[..chunks.end * WIDTH].as_chunks_mut::<WIDTH>().0;
        // Places beyond the sum's own coefficients are never read.
        let last = T::COEFFICIENTS - 1;
        let columns: [_; MOST] = std::array::from_fn(|j| self.coefficients[j.min(last)].reader());
        for i in chunks {
            let Touch {
                overlap,
                root,
                rate,
                ..
            } = sides.touch(simd, i);
            // Copies, so that the compiler sees that nothing overlaps.
            let k: [[f64; WIDTH]; MOST] = std::array::from_fn(|j| match j < T::COEFFICIENTS {
                true => *columns[j].at(i - self.first),
                false => [0.0; WIDTH],
            });
            let sum: [f64; WIDTH] = std::array::from_fn(|lane| {
                let contact = Closed {
                    overlap: overlap[lane],
                    root: root[lane],
                    rate: rate[lane],
                    largest: overlap[lane],
                };
                T::force(&k, lane, contact)
            });
            let sum: f64x8<S> = sum.simd_into(simd);
            // Added even to nothing: with the addition left out the compiler
            // scrambles the lanes of the sum.
            let before: f64x8<S> = match place.fresh {
                true => f64x8::splat(simd, 0.0),
                false => force[i].simd_into(simd),
            };
            force[i] = (before + sum).into();
        }
    }
}

impl<T: Sum> Sweep for Fused<T> {
    fn add(&mut self, set: InstructionSet, place: &Place<'_>, force: &mut [f64]) {
        let chunks = place.chunks(&self.contacts);
        if chunks.is_empty() {
            return;
        }
        dispatch!(set.level(), simd => simd.vectorize(
            #[inline(always)]
            || self.sweep(simd, place, chunks.clone(), force)
        ));
    }
}
