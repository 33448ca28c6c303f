//! What a user's solver reads: the bodies and the effects of a scene as two flat tables of
//! numbers, which homework in any language can take apart at the commas.

use std::io::Write;

use serde::Serialize;

use crate::engine::StepGrid;
use crate::recording::initial_states;
use crate::scene::{Attraction, Contact, Cushions, Drag, Effects, Gravity, Rest, Scene, Spring};

/// `name,mass,radius,x,y,z,vx,vy,vz`: a row a body, at time 0, in the scene's order.
pub(super) fn write_bodies(scene: &Scene, out: impl Write) -> Result<(), csv::Error> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(["name", "mass", "radius", "x", "y", "z", "vx", "vy", "vz"])?;
    for (body, state) in scene.bodies.iter().zip(initial_states(scene)) {
        let [x, v] = [state.position, state.velocity];
        table.serialize((
            &body.name,
            body.mass,
            body.radius,
            x.x,
            x.y,
            x.z,
            v.x,
            v.y,
            v.z,
        ))?;
    }
    table.flush()?;
    Ok(())
}

/// `effect,index,parameter,value`: a row a number, of the time grid and of the declared effects
/// alone. The index counts springs from 0 and is 0 elsewhere.
pub(super) fn write_effects(
    scene: &Scene,
    grid: StepGrid,
    out: impl Write,
) -> Result<(), csv::Error> {
    let mut rows = Rows(csv::Writer::from_writer(out));
    rows.0
        .write_record(["effect", "index", "parameter", "value"])?;
    rows.of("scene", 0, "duration", scene.duration)?;
    rows.of("scene", 0, "sample_every", scene.sample_every)?;
    rows.of("scene", 0, "step", grid.step)?;
    rows.of("scene", 0, "steps_per_sample", grid.steps_per_sample)?;
    rows.of("scene", 0, "samples", scene.sample_count())?;
    rows.effects(scene)?;
    rows.0.flush()?;
    Ok(())
}

struct Rows<W: Write>(csv::Writer<W>);

impl<W: Write> Rows<W> {
    fn of(
        &mut self,
        effect: &str,
        index: usize,
        parameter: &str,
        value: impl Serialize,
    ) -> Result<(), csv::Error> {
        self.0.serialize((effect, index, parameter, value))
    }

    fn effects(&mut self, scene: &Scene) -> Result<(), csv::Error> {
        // Taken apart, so that a new effect or parameter cannot be forgotten here.
        let Effects {
            contact,
            cushions,
            drag,
            rest,
            attraction,
            gravity,
            springs,
        } = &scene.effects;
        if let Some(Contact { restitution }) = contact {
            self.of("contact", 0, "restitution", restitution)?;
        }
        if let Some(cushions) = cushions {
            self.cushions(*cushions)?;
        }
        if let Some(Drag { coefficient }) = drag {
            self.of("drag", 0, "coefficient", coefficient)?;
        }
        if let Some(Rest { speed }) = rest {
            self.of("rest", 0, "speed", speed)?;
        }
        if let Some(Attraction {
            constant,
            softening,
        }) = attraction
        {
            self.of("attraction", 0, "constant", constant)?;
            if *softening != 0.0 {
                self.of("attraction", 0, "softening", softening)?;
            }
        }
        if let Some(Gravity { acceleration }) = gravity {
            let names = ["acceleration_x", "acceleration_y", "acceleration_z"];
            for (name, component) in names.into_iter().zip(acceleration) {
                self.of("gravity", 0, name, component)?;
            }
        }
        let ends = scene.spring_ends();
        for (index, (spring, ends)) in springs.iter().zip(ends).enumerate() {
            self.spring(index, spring, ends)?;
        }
        Ok(())
    }

    fn cushions(&mut self, cushions: Cushions) -> Result<(), csv::Error> {
        let Cushions {
            half_width,
            half_length,
            half_height,
            restitution,
        } = cushions;
        self.of("cushions", 0, "half_width", half_width)?;
        self.of("cushions", 0, "half_length", half_length)?;
        if let Some(half_height) = half_height {
            self.of("cushions", 0, "half_height", half_height)?;
        }
        self.of("cushions", 0, "restitution", restitution)
    }

    fn spring(
        &mut self,
        index: usize,
        spring: &Spring,
        ends: [usize; 2],
    ) -> Result<(), csv::Error> {
        let Spring {
            between: _,
            stiffness,
            rest_length,
            damping,
        } = spring;
        self.of("spring", index, "a", ends[0])?;
        self.of("spring", index, "b", ends[1])?;
        self.of("spring", index, "stiffness", stiffness)?;
        self.of("spring", index, "rest_length", rest_length)?;
        self.of("spring", index, "damping", damping)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: &str = "name='x'\nduration=5\nsample_every=0.0625\n\
        [[bodies]]\nname='a, or 1'\nmass=0.16\nradius=2\nposition=[-0.0,1e300,3]\nvelocity=[0,0.1,-5e-324]\n\
        [[bodies]]\nname='b'\nmass=1\nradius=1\nposition=[9,0,0]\nvelocity=[0,0,0]\n\
        [effects.contact]\nrestitution=0.9\n\
        [effects.cushions]\nhalf_width=710\nhalf_length=1420\nhalf_height=5\nrestitution=1\n\
        [effects.drag]\ncoefficient=0.05\n[effects.rest]\nspeed=10\n\
        [effects.attraction]\nconstant=5.5\nsoftening=0.25\n\
        [effects.gravity]\nacceleration=[0,-9.81,0]\n\
        [[effects.springs]]\nbetween=['b','a, or 1']\nstiffness=100\nrest_length=1\ndamping=0.5\n";

    fn text(write: impl FnOnce(&mut Vec<u8>) -> Result<(), csv::Error>) -> String {
        let mut table = Vec::new();
        write(&mut table).unwrap();
        String::from_utf8(table).unwrap()
    }

    #[test]
    fn bodies_are_written_with_all_their_digits_and_no_negative_zero() {
        let scene = crate::scene::parse(ALL, "x").unwrap();
        assert_eq!(
            text(|out| write_bodies(&scene, out)),
            "name,mass,radius,x,y,z,vx,vy,vz\n\
             \"a, or 1\",0.16,2.0,0.0,1e300,3.0,0.0,0.1,-5e-324\n\
             b,1.0,1.0,9.0,0.0,0.0,0.0,0.0,0.0\n"
        );
    }

    #[test]
    fn every_effect_has_its_rows_and_every_value_is_a_number() {
        let scene = crate::scene::parse(ALL, "x").unwrap();
        let grid = StepGrid::new(&scene, 0.01).unwrap();
        let table = text(|out| write_effects(&scene, grid, out));
        assert_eq!(
            table,
            "effect,index,parameter,value\n\
             scene,0,duration,5.0\nscene,0,sample_every,0.0625\nscene,0,step,0.008928571428571428\n\
             scene,0,steps_per_sample,7\nscene,0,samples,80\n\
             contact,0,restitution,0.9\n\
             cushions,0,half_width,710.0\ncushions,0,half_length,1420.0\n\
             cushions,0,half_height,5.0\ncushions,0,restitution,1.0\n\
             drag,0,coefficient,0.05\nrest,0,speed,10.0\n\
             attraction,0,constant,5.5\nattraction,0,softening,0.25\n\
             gravity,0,acceleration_x,0.0\ngravity,0,acceleration_y,-9.81\n\
             gravity,0,acceleration_z,0.0\n\
             spring,0,a,1\nspring,0,b,0\nspring,0,stiffness,100.0\n\
             spring,0,rest_length,1.0\nspring,0,damping,0.5\n"
        );
        for row in table.lines().skip(1) {
            assert!(
                row.rsplit(',').next().unwrap().parse::<f64>().is_ok(),
                "{row}"
            );
        }
    }

    #[test]
    fn what_is_not_declared_has_no_row() {
        let bare = ALL.split("[effects.contact]").next().unwrap();
        let bare = format!("{bare}[effects.attraction]\nconstant=1\n");
        let scene = crate::scene::parse(&bare, "x").unwrap();
        let grid = StepGrid::new(&scene, 0.01).unwrap();
        let table = text(|out| write_effects(&scene, grid, out));
        let effects: Vec<_> = table.lines().skip(6).collect();
        assert_eq!(effects, ["attraction,0,constant,1.0"]);
    }
}
