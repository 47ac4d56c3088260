//! Options back into words, so that a result tells how it came about.
//!
//! Left out is what no number depends on: threads, where results go, whether a chain is
//! continued; and where data and model come from, which results tell for themselves.

use super::infer::{
    Against, Assignment, Cost, Design, Fit, Freed, Gauge, Measured, Modelled, Push, Recorded,
};
use clap::ValueEnum;
use std::fmt::Display;

/// Words of a command line.
#[derive(Default)]
struct Words(Vec<String>);

impl Words {
    fn one(mut self, name: &str, value: impl Display) -> Self {
        self.0.push(format!("--{name}={value}"));
        self
    }

    fn maybe(self, name: &str, value: Option<impl Display>) -> Self {
        match value {
            None => self,
            Some(value) => self.one(name, value),
        }
    }

    fn flag(mut self, name: &str, given: bool) -> Self {
        self.0.extend(given.then(|| format!("--{name}")));
        self
    }

    fn each(self, name: &str, values: impl IntoIterator<Item: Display>) -> Self {
        let values = values.into_iter();
        values.fold(self, |words, value| words.one(name, value))
    }

    /// Values in one word, separated by commas; none if there are none.
    fn listed<T: Display>(self, name: &str, values: impl IntoIterator<Item = T>) -> Self {
        let values: Vec<String> = values.into_iter().map(|value| value.to_string()).collect();
        self.maybe(name, (!values.is_empty()).then(|| values.join(",")))
    }

    fn measured(self, measured: &Measured) -> Self {
        let Measured {
            case,
            observables,
            speed_error,
            tof_error,
            ratio_error,
            error_shots,
        } = measured;
        self.maybe("case", case.as_ref())
            .listed("use", observables.iter().map(name))
            .maybe("speed-error", *speed_error)
            .maybe("tof-error", *tof_error)
            .maybe("ratio-error", *ratio_error)
            .maybe("error-shots", *error_shots)
    }

    fn modelled(self, modelled: &Modelled) -> Self {
        let Modelled {
            model: _,
            preset: _,
            set,
            accuracy,
            threads: _,
        } = modelled;
        self.each("set", set).one("accuracy", accuracy)
    }

    fn freed(self, freed: &Freed) -> Self {
        let Freed {
            free,
            start,
            bounds,
            prior,
            scale,
        } = freed;
        self.listed("free", free)
            .each("start", start)
            .each("bounds", bounds)
            .each("prior", prior)
            .each("scale", scale)
    }

    fn recorded(self, recorded: &Recorded) -> Self {
        let Recorded {
            shots,
            rate,
            channel,
            low_pass,
            filter,
            most_shots,
        } = recorded;
        self.maybe("shots", shots.as_ref().map(|path| path.display()))
            .maybe("rate", *rate)
            .each("channel", channel)
            .maybe("low-pass", *low_pass)
            .maybe("filter", filter.as_ref().map(name))
            .one("most-shots", most_shots)
    }
}

/// What an option calls a value.
fn name(value: &impl ValueEnum) -> String {
    let value = value.to_possible_value();
    value.map_or(String::new(), |value| value.get_name().to_owned())
}

impl Display for Assignment {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}={}", self.name, self.text)
    }
}

impl Display for Against {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}={}", self.model, self.free.join(","))
    }
}

impl Display for Push {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Nothing => write!(f, "none"),
            Self::Of(force_n) => write!(f, "{force_n}"),
        }
    }
}

impl Display for Cost {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}={}", name(&self.of), self.value)
    }
}

impl Fit {
    /// Options that give the same numbers again with the same data and model.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        let Self {
            data: _,
            recorded,
            measured,
            modelled,
            freed,
            method,
            against,
            steps,
            direct,
            resume: _,
            robust,
            starts,
            seed,
            json: _,
            out: _,
        } = self;
        let words = Words::default().recorded(recorded).measured(measured);
        let words = words.modelled(modelled).freed(freed);
        let words = words
            .one("method", name(method))
            .each("against", against)
            .one("steps", steps)
            .flag("direct", *direct)
            .flag("robust", *robust)
            .one("starts", starts)
            .one("seed", seed);
        words.0
    }
}

impl Design {
    /// Options that give the same numbers again with the same data and model.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        let Self {
            data: _,
            measured,
            modelled,
            freed,
            target,
            speeds,
            preloads,
            sensors,
            costs,
            picks,
            json: _,
            out: _,
        } = self;
        let words = Words::default().measured(measured);
        let words = words.modelled(modelled).freed(freed);
        let words = words
            .listed("target", target)
            .maybe("speeds", speeds.as_ref())
            .listed("preloads", preloads)
            .listed("sensors", sensors.iter().flatten())
            .listed("costs", costs)
            .one("picks", picks);
        words.0
    }
}

impl Gauge {
    /// Options that give the same numbers again with the same data and models.
    #[must_use]
    pub fn words(&self) -> Vec<String> {
        let Self {
            wet: _,
            dry: _,
            wet_case,
            dry_case,
            measured,
            model: _,
            preset: _,
            dry_model: _,
            dry_preset: _,
            dry_free,
            own,
            form,
            oils: _,
            accuracy,
            threads: _,
            json: _,
            out: _,
        } = self;
        let words = Words::default()
            .maybe("wet-case", wet_case.as_ref())
            .maybe("dry-case", dry_case.as_ref())
            .measured(measured)
            .listed("dry-free", dry_free)
            .listed("own", own)
            .one("form", name(form))
            .one("accuracy", accuracy);
        words.0
    }
}

#[cfg(test)]
#[path = "tests/words.rs"]
mod tests;
