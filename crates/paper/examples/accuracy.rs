//! Errors and force passes of the paper's shots: the tables of `docs/explanation/numerics.md`.
//!
//! ```sh
//! cargo run --release -p hertzchain-paper --example accuracy           # by accuracy asked
//! cargo run --release -p hertzchain-paper --example accuracy -- steps  # by step
//! cargo run --release -p hertzchain-paper --example accuracy -- rounding
//! cargo run --release -p hertzchain-paper --example accuracy -- estimates
//! ```
//!
//! Errors are the larger ones of both times of flight, against the wave loop
//! at 1e-11, over eleven speeds. Force passes are means over these speeds: of a
//! sweep, those that stayed in the ensemble, without the shots that evaluate them.
//! Rounding is what single precision changes at equal steps. Judges are the two
//! longer steps by which a sweep reports how good a shot is: how many of the 66
//! pass, and the largest error of those that do over what was asked.

use hertzchain_chain::ensemble::{self, End, LaneResult, Precision};
use hertzchain_chain::observe::Passages;
use hertzchain_chain::wave::Work;
use hertzchain_chain::{Sensor, System};
use hertzchain_experiment::preset;
use hertzchain_paper::reproduce::CASES;
use hertzchain_sim::{Control, Flight, InstructionSet, LONGER_STEPS, Plan, Shot, run_plans, shoot};
use std::error::Error;

const SPEEDS_M_S: [f64; 11] = [0.075, 0.1, 0.14, 0.2, 0.25, 0.3, 0.4, 0.5, 0.75, 1.0, 1.23];

const ACCURACIES: [f64; 4] = [1e-4, 1e-5, 1e-6, 1e-7];

/// In contact times.
const STEPS: [f64; 12] = [0.22, 0.2, 0.18, 0.16, 0.135, 0.12, 0.1, 0.08, 0.06, 0.05, 0.03, 0.02];

/// Accuracy of what errors are measured against.
const EXACT: f64 = 1e-11;

/// Longest duration of a shot in s; the slowest ones take half of it.
const LONGEST_S: f64 = 2e-2;

type Result<T> = std::result::Result<T, Box<dyn Error>>;

fn main() -> Result<()> {
    match std::env::args().nth(1).as_deref() {
        None => by_accuracy(),
        Some("steps") => by_step(),
        Some("rounding") => rounding(),
        Some("estimates") => evaluates(),
        Some(other) => {
            Err(format!("`{other}` is none of `steps`, `rounding`, `estimates`, nor nothing")
                .into())
        }
    }
}

fn plans(name: &str, accuracy: f64) -> Result<Vec<Plan>> {
    let experiment = preset(name)?;
    let plan = |speed: &f64| {
        let (plan, _) = Plan::from_experiment(&experiment, Some(*speed))?;
        Ok(plan.for_flights().with_accuracy(accuracy))
    };
    SPEEDS_M_S.iter().map(plan).collect()
}

/// Shots by the wave loop.
fn one_by_one(name: &str, accuracy: f64) -> Result<Vec<Shot>> {
    let plans = plans(name, accuracy)?;
    plans.iter().map(|plan| Ok(shoot(plan)?)).collect()
}

/// Shots as a sweep fires them.
fn together(name: &str, accuracy: f64) -> Result<Vec<Shot>> {
    let plans = plans(name, accuracy)?;
    let shots =
        run_plans(&plans, Control::PerShot { checked: false }, InstructionSet::default(), &|| {});
    shots.into_iter().map(|shot| Ok(shot?)).collect()
}

/// Errors at all speeds; `None` where there is no flight.
fn errors(flights: impl Iterator<Item = Option<Flight>>, exact: &[Shot]) -> Vec<Option<f64>> {
    let exact = exact.iter().map(|shot| shot.flight);
    let error = |(flight, exact): (Option<Flight>, Option<Flight>)| Some(flight?.change(&exact?));
    flights.zip(exact).map(error).collect()
}

/// The largest error, where it is, and how many shots have none.
fn reported(errors: &[Option<f64>]) -> String {
    let known = errors.iter().zip(SPEEDS_M_S).filter_map(|(e, v)| Some(((*e)?, v)));
    let worst = known.reduce(|most, here| if here.0 > most.0 { here } else { most });
    let lost = errors.iter().filter(|error| error.is_none()).count();
    let worst = worst.map_or_else(String::new, |(error, v)| format!("{error:.1e} at {v}"));
    match lost {
        0 => worst,
        _ => format!("{worst} ({lost} lost)"),
    }
}

fn mean_passes<'a>(works: impl Iterator<Item = &'a Work>) -> f64 {
    let passes: Vec<u64> = works.map(|work| work.force_passes).collect();
    passes.iter().sum::<u64>() as f64 / passes.len() as f64
}

fn by_accuracy() -> Result<()> {
    println!("| preset | asked | sweep | passes | stayed, of 11 | wave loop | passes |");
    for name in CASES {
        let exact = one_by_one(name, EXACT)?;
        for accuracy in ACCURACIES {
            let sweep = together(name, accuracy)?;
            let wave = one_by_one(name, accuracy)?;
            let stayed = sweep.iter().filter(|shot| shot.step_s.is_some());
            let inside = stayed.clone().count();
            let passes = mean_passes(stayed.map(|shot| &shot.work));
            let of_wave = mean_passes(wave.iter().map(|shot| &shot.work));
            let [error, wave] = [&sweep, &wave].map(|shots| {
                let flights = shots.iter().map(|shot| shot.flight);
                reported(&errors(flights, &exact))
            });
            println!(
                "| {name} | {accuracy:.0e} | {error} | {passes:.0} | {inside} | {wave} | {of_wave:.0} |"
            );
        }
    }
    Ok(())
}

/// Precisions and whether openings are found, as in the tables.
const KINDS: [(Precision, bool); 4] = [
    (Precision::Double, false),
    (Precision::Single, false),
    (Precision::Double, true),
    (Precision::Single, true),
];

fn by_step() -> Result<()> {
    let names = CASES.join(" | ");
    println!("| precision | openings | step | {names} | passes, dry | until it has passed |");
    let exact = CASES.iter().map(|name| one_by_one(name, EXACT));
    let exact = exact.collect::<Result<Vec<_>>>()?;
    for kind in KINDS {
        for step in STEPS {
            let (precision, openings) = kind;
            let mut row = format!("| {precision:?} | {openings} | {step} |");
            for (name, exact) in CASES.iter().zip(&exact) {
                let flown = flown(name, step, kind, End::Reflected)?;
                let flights = flown.into_iter().map(|flown| flight(flown?));
                row += &format!(" {} |", reported(&errors(flights, exact)));
            }
            for end in [End::Reflected, End::Passed] {
                let flown = flown("dry", step, kind, end)?;
                let works = flown.iter().flatten().map(|flown| &flown.work);
                row += &format!(" {:.0} |", mean_passes(works));
            }
            println!("{row}");
        }
    }
    Ok(())
}

fn rounding() -> Result<()> {
    println!("| preset | openings | step | incident | reflected |");
    let kinds = [false, true].into_iter();
    let kinds = kinds.flat_map(|openings| STEPS.map(|step| (openings, step)));
    for (name, (openings, step)) in
        CASES.iter().flat_map(|name| kinds.clone().map(move |kind| (name, kind)))
    {
        let fly = |precision| flown(name, step, (precision, openings), End::Reflected);
        let (double, single) = (fly(Precision::Double)?, fly(Precision::Single)?);
        let pairs = double.into_iter().zip(single);
        let changes = pairs.filter_map(|(double, single)| rounded(double?, single?));
        let [incident, reflected] =
            changes.fold([0.0_f64; 2], |most, change| [0, 1].map(|i| most[i].max(change[i])));
        println!("| {name} | {openings} | {step} | {incident:.1e} | {reflected:.1e} |");
    }
    Ok(())
}

/// Accuracies asked, whether in single precision, whether openings are found,
/// and steps to try.
const TRIED: [(f64, Precision, bool, [f64; 6]); 5] = [
    (1e-3, Precision::Single, false, [0.2, 0.19, 0.18, 0.17, 0.16, 0.15]),
    (1e-4, Precision::Single, false, [0.16, 0.15, 0.14, 0.13, 0.12, 0.11]),
    (1e-5, Precision::Double, true, [0.11, 0.1, 0.09, 0.08, 0.07, 0.06]),
    (1e-6, Precision::Double, true, [0.05, 0.045, 0.04, 0.036, 0.033, 0.03]),
    (1e-7, Precision::Double, true, [0.02, 0.018, 0.016, 0.014, 0.013, 0.012]),
];

fn evaluates() -> Result<()> {
    println!("| asked | precision | openings | step | pass | largest error over asked |");
    let exact = CASES.iter().map(|name| one_by_one(name, EXACT));
    let exact = exact.collect::<Result<Vec<_>>>()?;
    for (asked, precision, openings, steps) in TRIED {
        for step in steps {
            let mut passed = Vec::new();
            for (name, exact) in CASES.iter().zip(&exact) {
                let fly = |step| flown(name, step, (precision, openings), End::Reflected);
                let flights = |step| -> Result<Vec<Option<Flight>>> {
                    Ok(fly(step)?.into_iter().map(|f| flight(f?)).collect())
                };
                let own = flights(step)?;
                let longer =
                    LONGER_STEPS.map(|(longer, counts)| Ok((flights(longer * step)?, counts)));
                let longer = longer.into_iter().collect::<Result<Vec<_>>>()?;
                let passes = |at: usize| {
                    let own = own[at]?;
                    let change = |(evaluate, counts): &(Vec<Option<Flight>>, f64)| {
                        Some(counts * own.change(&evaluate[at]?))
                    };
                    let changes: Option<Vec<f64>> = longer.iter().map(change).collect();
                    let within = changes?.into_iter().all(|change| change <= asked);
                    within.then_some(own)
                };
                let kept: Vec<_> = (0..own.len()).map(passes).collect();
                passed.extend(errors(kept.into_iter(), exact).into_iter().flatten());
            }
            let worst = passed.iter().fold(0.0_f64, |most, error| most.max(*error));
            let (passed, worst) = (passed.len(), worst / asked);
            println!(
                "| {asked:.0e} | {precision:?} | {openings} | {step} | {passed} | {worst:.2} |"
            );
        }
    }
    Ok(())
}

/// Relative changes of the incident and the reflected time of flight.
fn rounded(double: LaneResult, single: LaneResult) -> Option<[f64; 2]> {
    let (double, single) = (flight(double)?, flight(single)?);
    let incident = single.incident_s / double.incident_s;
    let reflected = single.reflected_s? / double.reflected_s?;
    Some([incident, reflected].map(|ratio| (ratio - 1.0).abs()))
}

/// Shots with a step in contact times; `None` where a sweep would not trust one.
fn flown(
    name: &str,
    step: f64,
    (precision, openings): (Precision, bool),
    end: End,
) -> Result<Vec<Option<LaneResult>>> {
    let plans = plans(name, EXACT)?;
    let systems = plans.iter().map(|plan| Ok(System::new(&plan.chain)?));
    let systems = systems.collect::<Result<Vec<_>>>()?;
    let shot = |system| ensemble::Shot { system, step, duration_s: LONGEST_S, precision };
    let shots: Vec<_> = systems.iter().map(shot).collect();
    let wall = systems[0].contacts() - 1;
    let settings = ensemble::Settings {
        sensors: vec![Sensor::Bead(plans[0].sensor_bead), Sensor::Contact(wall)],
        end,
        set: InstructionSet::default(),
        shapes: false,
        whole_chain: false,
        openings,
    };
    let flown = ensemble::fire(&shots, &settings).into_iter();
    Ok(flown.map(std::result::Result::ok).collect())
}

fn flight(flown: LaneResult) -> Option<Flight> {
    let [sensor, wall] = <[_; 2]>::try_from(flown.signals).ok()?;
    let passages = Passages::from_signals(sensor, wall, flown.time_s);
    let passage = passages.passage().ok()?;
    Some(Flight { incident_s: passage.tof_incident_s(), reflected_s: passage.tof_reflected_s() })
}
