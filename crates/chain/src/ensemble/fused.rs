//! Sums of laws that the loop runs in one go.
//!
//! Any section of a chain runs through [`super::section`]; the sums listed in
//! [`fuse`] run faster, because nothing is stored between one law and the
//! next. A law needs no line here.

use super::column::Column;
use super::number::Number;
use super::section::{Place, Sweep};
use super::touch::{Sides, Touch};
use crate::instruction_set::InstructionSet;
use crate::laws::{Arithmetic, Closed, DampingCubic, DampingViscoelastic, ElasticHertz, Wide};
use fearless_simd::{dispatch, prelude::*};
use std::marker::PhantomData;
use std::ops::Range;

/// Most coefficients of a fused sum.
const MOST: usize = 3;

/// A sum of terms known when compiling.
pub(super) trait Sum: Send + Sync + 'static {
    /// Coefficients of all terms.
    const COEFFICIENTS: usize;

    /// The force of as many contacts as a number stands for.
    fn force<N: Arithmetic>(k: &[N], contact: Closed<N>) -> N;
}

/// A sum of one.
struct One<T, const C: usize>(PhantomData<fn() -> T>);

impl<T: Wide<C>, const C: usize> Sum for One<T, C> {
    const COEFFICIENTS: usize = C;

    #[inline(always)]
    fn force<N: Arithmetic>(k: &[N], contact: Closed<N>) -> N {
        T::wide_force(std::array::from_fn(|j| k[j]), contact)
    }
}

impl<A: Sum, B: Sum> Sum for (A, B) {
    const COEFFICIENTS: usize = A::COEFFICIENTS + B::COEFFICIENTS;

    #[inline(always)]
    fn force<N: Arithmetic>(k: &[N], contact: Closed<N>) -> N {
        let (a, b) = k.split_at(A::COEFFICIENTS);
        A::force(a, contact) + B::force(b, contact)
    }
}

type Hertz = One<ElasticHertz, 1>;
type Viscoelastic = (Hertz, One<DampingViscoelastic, 1>);
type Dry = (Viscoelastic, One<DampingCubic, 1>);

/// The fast sweep over a section with these laws, in this order, if there is one.
pub(super) fn fuse<N: Number<W>, const W: usize>(
    laws: &[&str],
    contacts: Range<usize>,
    lanes: usize,
    coefficients: Vec<Column<N, W>>,
) -> Option<Box<dyn Sweep<N, W>>> {
    let first = contacts.start * lanes / W;
    let section = (contacts, first, coefficients);
    Some(match laws {
        ["elastic_hertz"] => Box::new(Fused::<Hertz, N, W>::new(section)),
        ["elastic_hertz", "damping_viscoelastic"] => {
            Box::new(Fused::<Viscoelastic, N, W>::new(section))
        }
        ["elastic_hertz", "damping_viscoelastic", "damping_cubic"] => {
            Box::new(Fused::<Dry, N, W>::new(section))
        }
        _ => return None,
    })
}

/// A section whose laws are a fused sum.
struct Fused<T, N, const W: usize> {
    contacts: Range<usize>,
    /// Chunk in which the section and its coefficients begin.
    first: usize,
    coefficients: Vec<Column<N, W>>,
    sum: PhantomData<fn() -> T>,
}

impl<T: Sum, N: Number<W>, const W: usize> Fused<T, N, W> {
    fn new((contacts, first, coefficients): (Range<usize>, usize, Vec<Column<N, W>>)) -> Self {
        Self {
            contacts,
            first,
            coefficients,
            sum: PhantomData,
        }
    }

    #[inline(always)]
    fn sweep<S: Simd>(
        &self,
        simd: S,
        place: &Place<'_, N, W>,
        chunks: Range<usize>,
        force: &mut [N],
    ) {
        let load = |chunk: &[N; W]| N::Wide::<S>::load_array_ref(simd, chunk);
        // Places beyond the sum's own coefficients are never read.
        let last = T::COEFFICIENTS - 1;
        let column = |j: usize| &self.coefficients[j.min(last)];
        let columns = [column(0), column(1), column(2)];
        let same = |j: usize| columns[j].uniform();
        if let (Some(a), Some(b), Some(c)) = (same(0), same(1), same(2)) {
            // Loaded once, they stay in registers.
            let k = [load(a), load(b), load(c)];
            pass::<T, S, N, W>(simd, place, chunks, force, |_| k);
        } else {
            let columns = columns.map(Column::reader);
            pass::<T, S, N, W>(simd, place, chunks, force, |i| {
                columns.map(|column| load(column.at(i - self.first)))
            });
        }
    }
}

/// Forces of chunks of contacts whose coefficients `k` gives.
#[inline(always)]
fn pass<T: Sum, S: Simd, N: Number<W>, const W: usize>(
    simd: S,
    place: &Place<'_, N, W>,
    chunks: Range<usize>,
    force: &mut [N],
    k: impl Fn(usize) -> [N::Wide<S>; MOST],
) {
    let (first, fresh) = (chunks.start, place.fresh);
    let force = force[first * W..chunks.end * W].as_chunks_mut::<W>().0;
    let sides = Sides::new(place, first, force.len());
    for (i, force) in force.iter_mut().enumerate() {
        let Touch {
            overlap,
            root,
            rate,
            ..
        } = sides.touch(simd, i);
        let contact = Closed {
            overlap,
            root,
            rate,
            largest: overlap,
        };
        let sum = T::force(&k(first + i), contact);
        let sum = match fresh {
            true => sum,
            false => N::Wide::<S>::load_array_ref(simd, force) + sum,
        };
        sum.store_array(force);
    }
}

impl<T: Sum, N: Number<W>, const W: usize> Sweep<N, W> for Fused<T, N, W> {
    fn add(&mut self, set: InstructionSet, place: &Place<'_, N, W>, force: &mut [N]) {
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
