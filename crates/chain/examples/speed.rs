use hertzchain_chain::laws::*;
use hertzchain_chain::observe::*;
use hertzchain_chain::wave::*;
use hertzchain_chain::*;
fn main() {
    let m = Material {
        young_modulus_pa: 213e9,
        poisson_ratio: 0.3,
        shear_viscosity_pa_s: 3.2e4,
        bulk_viscosity_pa_s: 3.2e4,
    };
    let b = Bead {
        radius_m: 6.35e-3,
        mass_kg: 8.54e-3,
        material: m,
    };
    let chain = Chain {
        beads: vec![b; 40],
        start: Start::Striker {
            bead: b,
            speed_m_s: 0.5,
        },
        initial: vec![],
        push: Push::None,
        far: FarEnd::HalfBead {
            radius_m: 6.35e-3,
            material: m,
        },
        sections: vec![Section {
            contacts: 0..=40,
            laws: vec![
                law(ElasticHertz { stiffness: None }),
                law(DampingViscoelastic {
                    relaxation_time_s: None,
                    stiffness: None,
                }),
                law(DampingCubic {
                    coefficient_kg_s_m2: 77.,
                }),
            ],
            material: None,
        }],
        gaps: vec![],
        incline_rad: 0.,
        gravity_m_s2: 9.8,
        suspension_m: None,
        tension: Tension::Allowed,
    };
    let tol: f64 = std::env::args().nth(1).unwrap().parse().unwrap();
    let t = std::time::Instant::now();
    let n = 200;
    let mut w = None;
    for _ in 0..n {
        let s = System::new(&chain).unwrap();
        let mut p = Passages::new(7, 40, true);
        let o = run(
            &s,
            &DormandPrince { tolerance: tol },
            Limits::until(1.0),
            &mut [&mut p],
        )
        .unwrap();
        w = Some(o.work);
    }
    let e = t.elapsed().as_secs_f64() / n as f64;
    println!(
        "{:?} {:.1} us/shot {:.1} ns/pass",
        w,
        e * 1e6,
        e * 1e9 / w.unwrap().force_passes as f64
    );
}
