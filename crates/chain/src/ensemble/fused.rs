//! Sums of laws that the loop runs in one go.
//!
//! Any section of a chain runs through [`super::section`]; the sums listed in
//! [`fuse`] run faster, because nothing is stored between one law and the
//! next. A law needs no line here.

use super::column::LaneColumn;
use super::number::Number;
use super::section::{Place, Sweep};
use super::touch::{LaneTouch, Sides};
use crate::instruction_set::InstructionSet;
use crate::laws::{
    Arithmetic, Closed, DampingCubic, DampingViscoelastic, ElasticHertz, Split, Wide,
};
use fearless_simd::{dispatch, prelude::*};
use std::marker::PhantomData;
use std::ops::Range;

/// Most coefficients of a fused sum.
const MOST: usize = 3;

pub(super) trait Sum: Send + Sync + 'static {
    /// Coefficients of all terms.
    const COEFFICIENTS: usize;

    /// Adds the forces of as many contacts as a number stands for.
    fn add_to<N: Arithmetic>(sum: Split<N>, k: &[N], contact: Closed<N>) -> Split<N>;
}

struct One<T, const C: usize>(PhantomData<fn() -> T>);

impl<T: Wide<C>, const C: usize> Sum for One<T, C> {
    const COEFFICIENTS: usize = C;

    #[inline(always)]
    fn add_to<N: Arithmetic>(sum: Split<N>, k: &[N], contact: Closed<N>) -> Split<N> {
        T::add_to(sum, std::array::from_fn(|j| k[j]), contact)
    }
}

impl<A: Sum, B: Sum> Sum for (A, B) {
    const COEFFICIENTS: usize = A::COEFFICIENTS + B::COEFFICIENTS;

    #[inline(always)]
    fn add_to<N: Arithmetic>(sum: Split<N>, k: &[N], contact: Closed<N>) -> Split<N> {
        let (a, b) = k.split_at(A::COEFFICIENTS);
        B::add_to(A::add_to(sum, a, contact), b, contact)
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
    coefficients: Vec<LaneColumn<N, W>>,
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
    coefficients: Vec<LaneColumn<N, W>>,
    sum: PhantomData<fn() -> T>,
}

impl<T: Sum, N: Number<W>, const W: usize> Fused<T, N, W> {
    fn new((contacts, first, coefficients): (Range<usize>, usize, Vec<LaneColumn<N, W>>)) -> Self {
        Self { contacts, first, coefficients, sum: PhantomData }
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
            let columns = columns.map(LaneColumn::reader);
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
    let first = chunks.start;
    let force = force[first * W..chunks.end * W].as_chunks_mut::<W>().0;
    let sides = Sides::new(place, first, force.len());
    // Loops of their own, so that what most steps need is all that they do.
    let plain = place.offset_m.is_all(0.0) && !place.starting;
    match (plain, place.fresh) {
        (true, true) => {
            for (i, force) in force.iter_mut().enumerate() {
                sum::<T, S, N, W>(simd, &k(first + i), sides.plain_touch(simd, i))
                    .store_array(force);
            }
        }
        (_, true) => {
            for (i, force) in force.iter_mut().enumerate() {
                sum::<T, S, N, W>(simd, &k(first + i), sides.touch(simd, i)).store_array(force);
            }
        }
        (_, false) => {
            for (i, force) in force.iter_mut().enumerate() {
                let before = N::Wide::<S>::load_array_ref(simd, force);
                let more = sum::<T, S, N, W>(simd, &k(first + i), sides.touch(simd, i));
                (before + more).store_array(force);
            }
        }
    }
}

#[inline(always)]
fn sum<T: Sum, S: Simd, N: Number<W>, const W: usize>(
    simd: S,
    k: &[N::Wide<S>],
    touch: LaneTouch<N::Wide<S>>,
) -> N::Wide<S> {
    let contact = Closed {
        overlap: touch.overlap,
        root: touch.root,
        rate: touch.rate,
        largest: touch.overlap,
    };
    // Minus 0 changes no sum and no sign: the compiler leaves it out.
    let none = N::Wide::<S>::simd_from(simd, N::of(-0.0));
    let nothing = Split { rooted: none, plain: none };
    let Split { rooted, plain } = T::add_to(nothing, k, contact);
    touch.root.mul_add(rooted, plain)
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
