//! Work and precision: price over error, both on logarithmic axes, and which way is cheapest for
//! each of some accuracies.

use super::ChartError;
use super::canvas::{Align, Canvas, Lettering, picture};
use super::curves::Weight;
use super::legend::{Entry, Key, Legend};
use super::polyline::{Frame, Point, clipped, dotted};
use super::room::{FAR, NEAR, Room, around};
use super::text::{shortened, width};
use super::theme::{
    CANVAS, FRAME, GRID, INK, LABEL_PX, LineStyle, MARGIN, PAPER, Pen, QUIET, SMALL_PX, mix,
};
use super::work_figure::WorkFigure;
use super::work_look::{
    ANSWER, DOT, NAME_PX, NOTE_PX, RING, ink, pen, point_radius, quiet, ring, stairs,
};
use super::work_plot::{Plot, layout, price_label};

/// Draws prices over errors as a PNG.
///
/// # Errors
/// None that depends on the data: see [`ChartError`].
pub fn work(figure: &WorkFigure) -> Result<Vec<u8>, ChartError> {
    picture(|canvas| {
        let mut top = canvas.heading(&figure.title, &figure.subtitle)?;
        let legend = Legend::flow(&[entries(figure)], CANVAS[0] - 2.0 * MARGIN, 2)?;
        legend.draw(canvas, MARGIN, top)?;
        top += legend.height;
        let plot = layout(figure, top)?;
        draw_axes(canvas, figure, &plot)?;
        draw_goals(canvas, figure, &plot, top)?;
        for part in clipped(&front(figure, &plot), &plot.frame) {
            canvas.line(&part, stairs())?;
        }
        draw_price_label(canvas, figure, &plot)?;
        draw_enough(canvas, figure, &plot)?;
        draw_curves(canvas, figure, &plot)?;
        draw_labels(canvas, figure, &plot)
    })
}

fn entries(figure: &WorkFigure) -> Vec<Entry> {
    let mut keys = Vec::new();
    if figure.goals.iter().any(|goal| goal.answer.is_some()) {
        keys.push(Entry::new(
            Key::Ring(ring()),
            "cheapest with steps, named below",
        ));
    }
    if !figure.front.is_empty() {
        keys.push(Entry::new(Key::Line(stairs()), "Pareto front"));
    }
    if figure.curves.iter().any(|curve| !curve.others.is_empty()) {
        keys.push(Entry::new(Key::Remark, "small dots: other settings"));
    }
    keys
}

fn letters(px: f64, color: plotters::style::RGBColor, align: Align) -> Lettering {
    Lettering { px, color, align }
}

pub(super) fn draw_axes(
    canvas: &Canvas,
    figure: &WorkFigure,
    plot: &Plot,
) -> Result<(), ChartError> {
    let frame = &plot.frame;
    let band = plot.errors.zero_band();
    if band > 0.0 {
        let right = frame.x(0.7 * band);
        canvas.fill(&Frame { right, ..*frame }, mix(GRID, PAPER, 0.55))?;
    }
    for label in &plot.prices.labels {
        let y = frame.y(label.share);
        canvas.rule(&[[frame.left, y], [frame.right, y]], Pen::solid(GRID, 2.0))?;
        let look = letters(SMALL_PX, QUIET, Align::Right);
        canvas.text(&label.text, [frame.left - 12.0, y], look)?;
    }
    for label in &plot.errors.labels {
        let x = frame.x(label.share);
        canvas.rule(&[[x, frame.top], [x, frame.bottom]], Pen::solid(GRID, 2.0))?;
        let look = letters(SMALL_PX, QUIET, Align::Center);
        canvas.text(&label.text, [x, frame.bottom + 22.0], look)?;
    }
    canvas.rule(&frame.outline(), Pen::solid(FRAME, 2.0))?;
    let label = shortened(&figure.x_label, LABEL_PX, frame.width())?;
    let middle = f64::midpoint(frame.left, frame.right);
    let look = letters(LABEL_PX, INK, Align::Center);
    canvas.text(&label, [middle, frame.bottom + 60.0], look)
}

/// Draws the name of the upright axis, on paper: lines end there.
fn draw_price_label(canvas: &Canvas, figure: &WorkFigure, plot: &Plot) -> Result<(), ChartError> {
    let (name, place) = price_label(figure, plot)?;
    canvas.fill(&place, PAPER)?;
    let row = f64::midpoint(place.top, place.bottom);
    canvas.text(
        &name,
        [place.left, row],
        letters(LABEL_PX, INK, Align::Left),
    )
}

/// An upright line for each accuracy asked for, and above it who gets there, and how.
fn draw_goals(
    canvas: &Canvas,
    figure: &WorkFigure,
    plot: &Plot,
    top: f64,
) -> Result<(), ChartError> {
    let frame = &plot.frame;
    let count = figure.goals.iter().fold(0.0, |count, _| count + 1.0);
    let room = (CANVAS[0] - 2.0 * MARGIN) / count;
    let mut middle = MARGIN + room / 2.0;
    for goal in &figure.goals {
        if let Some(x) = plot.column(goal.error) {
            let below = top + 3.0 * ANSWER;
            let line = [[middle, below], [middle, below + 6.0], [x, frame.top - 4.0]];
            let pen = Pen::solid(mix(QUIET, PAPER, 0.35), 2.0);
            canvas.line(
                &[line[0], line[1], line[2], [x, frame.top], [x, frame.bottom]],
                pen,
            )?;
        }
        let said = match &goal.answer {
            Some(answer) => [
                (&*goal.name, LABEL_PX, QUIET),
                (&*answer.who, NAME_PX, ink(answer.color)),
                (&*answer.how, LABEL_PX, INK),
            ],
            None => [
                (&*goal.name, LABEL_PX, QUIET),
                ("not reached", NAME_PX, QUIET),
                ("within the budget", LABEL_PX, QUIET),
            ],
        };
        let mut row = top + 0.5 * ANSWER;
        for (text, px, color) in said {
            let text = shortened(text, px, room - 24.0)?;
            canvas.text(&text, [middle, row], letters(px, color, Align::Center))?;
            row += ANSWER;
        }
        middle += room;
    }
    Ok(())
}

/// The line where accuracy stops mattering.
fn draw_enough(canvas: &Canvas, figure: &WorkFigure, plot: &Plot) -> Result<(), ChartError> {
    let Some((error, _)) = &figure.enough else {
        return Ok(());
    };
    let frame = &plot.frame;
    let Some(x) = plot.column(*error) else {
        return Ok(());
    };
    let pen = Pen {
        color: INK,
        width: 3.0,
        style: LineStyle::Dashed,
    };
    canvas.line(&[[x, frame.top], [x, frame.bottom]], pen)
}

/// The stairs of the front: below and to the left of them is nothing. Their round ends lie
/// within the frame.
fn front(figure: &WorkFigure, plot: &Plot) -> Vec<Point> {
    let frame = plot.frame.inset(stairs().width / 2.0);
    let places = figure.front.iter().filter_map(|point| plot.place(*point));
    let mut line: Vec<Point> = Vec::new();
    for at in places {
        let above = line.last().map_or(frame.top, |last| last[1]);
        line.extend([[at[0], above], at]);
    }
    line.extend(line.last().map(|last| [frame.right, last[1]]));
    line
}

pub(super) fn draw_curves(
    canvas: &Canvas,
    figure: &WorkFigure,
    plot: &Plot,
) -> Result<(), ChartError> {
    for weight in [Weight::Aside, Weight::Main] {
        let curves = || figure.curves.iter().filter(|curve| curve.weight == weight);
        for curve in curves() {
            let pale = mix(pen(curve).color, PAPER, 0.45);
            for at in curve.others.iter().filter_map(|point| plot.place(*point)) {
                canvas.disc(at, DOT, pale)?;
            }
        }
        for curve in curves() {
            let places: Vec<Point> = plot.places(curve).iter().map(|(at, _)| *at).collect();
            if places.len() > 1 {
                for part in clipped(&places, &plot.frame) {
                    canvas.line(&part, pen(curve))?;
                }
            }
            for at in places {
                canvas.disc(at, point_radius(curve), pen(curve).color)?;
            }
        }
    }
    let answers = figure.goals.iter().filter_map(|goal| goal.answer.as_ref());
    for at in answers.filter_map(|answer| plot.place(answer.at)) {
        canvas.ring(at, RING, ring())?;
    }
    Ok(())
}

/// What labels must not cover.
fn room(figure: &WorkFigure, plot: &Plot) -> Result<Room, ChartError> {
    let mut room = Room::new(plot.frame);
    room.take(price_label(figure, plot)?.1);
    let enough = figure.enough.as_ref();
    if let Some(x) = enough.and_then(|(error, _)| plot.column(*error)) {
        room.take(Frame {
            left: x - 4.0,
            right: x + 4.0,
            ..plot.frame
        });
    }
    for at in dotted(&front(figure, plot), 0.0, 2.0 * DOT) {
        room.spare(around(at, stairs().width / 2.0));
    }
    for goal in &figure.goals {
        if let Some(at) = goal
            .answer
            .as_ref()
            .and_then(|answer| plot.place(answer.at))
        {
            room.take(around(at, RING));
        }
        if let Some(x) = plot.column(goal.error) {
            room.spare(Frame {
                left: x - 1.0,
                right: x + 1.0,
                ..plot.frame
            });
        }
    }
    for curve in &figure.curves {
        let line: Vec<Point> = plot.places(curve).iter().map(|(at, _)| *at).collect();
        for at in &line {
            let point = around(*at, point_radius(curve));
            match curve.weight {
                Weight::Main => room.take(point),
                Weight::Aside => room.spare(point),
            }
        }
        for at in curve.others.iter().filter_map(|point| plot.place(*point)) {
            room.spare(around(at, DOT));
        }
        for at in dotted(&line, 0.0, 2.0 * DOT) {
            room.spare(around(at, DOT));
        }
    }
    Ok(room)
}

/// The name of each curve beside it and the steps at its ends, where there is room.
fn draw_labels(canvas: &Canvas, figure: &WorkFigure, plot: &Plot) -> Result<(), ChartError> {
    let mut room = room(figure, plot)?;
    let mut put = |text: &str, at: &[Point], gaps: &[f64], px: f64, color| {
        let size = [width(text, px)?, 1.1 * px];
        let Some(free) = room.beside(at, gaps, size) else {
            return Ok(());
        };
        let row = f64::midpoint(free.top, free.bottom);
        canvas.text(text, [free.left, row], letters(px, color, Align::Left))
    };
    if let Some((error, label)) = &figure.enough {
        // From below up: less than the front is nowhere, so there is room.
        let rows = [0.06, 0.14, 0.22, 0.3, 0.5, 0.7, 0.9].map(|share| plot.frame.y(share));
        let line: Vec<Point> = plot
            .column(*error)
            .map_or(Vec::new(), |x| rows.map(|y| [x, y]).to_vec());
        put(label, &line, &NEAR, NOTE_PX, INK)?;
    }
    let of = |weight| {
        figure
            .curves
            .iter()
            .filter(move |curve| curve.weight == weight)
    };
    for curve in of(Weight::Main) {
        // From the finest step on: there curves are farthest apart.
        let places = plot.places(curve).into_iter().rev();
        let places: Vec<Point> = places.map(|(at, _)| at).collect();
        put(&curve.label, &places, &FAR, NAME_PX, ink(curve.color))?;
    }
    for curve in of(Weight::Main) {
        let places = plot.places(curve);
        let ends = places
            .first()
            .into_iter()
            .chain(places.iter().skip(1).next_back());
        for (at, point) in ends.filter(|(_, point)| !point.label.is_empty()) {
            put(&point.label, &[*at], &NEAR, NOTE_PX, ink(curve.color))?;
        }
    }
    for curve in of(Weight::Aside) {
        let places: Vec<Point> = plot.places(curve).iter().map(|(at, _)| *at).collect();
        put(&curve.label, &places, &NEAR, NOTE_PX, quiet())?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::testing::decode;
    use super::super::text::register;
    use super::super::work_figure::{Answer, Goal, WorkCurve, WorkPoint};
    use super::*;

    fn point(error: f64, price: f64) -> WorkPoint {
        WorkPoint {
            error,
            price,
            label: "0.1 s".to_owned(),
        }
    }

    fn figure(points: Vec<WorkPoint>) -> WorkFigure {
        WorkFigure {
            title: "t".into(),
            subtitle: "s".into(),
            x_label: "error [mm]".into(),
            y_label: "price".into(),
            least: 1e-6,
            curves: vec![WorkCurve {
                label: "a".into(),
                color: 0,
                line: LineStyle::Solid,
                weight: Weight::Main,
                points,
                others: vec![[1.0, 1.0]],
            }],
            front: vec![[0.1, 10.0], [1.0, 1.0]],
            goals: vec![Goal {
                error: 0.5,
                name: "half".into(),
                answer: Some(Answer {
                    who: "a".into(),
                    color: 0,
                    how: "0.1 s".into(),
                    at: [0.1, 10.0],
                }),
            }],
            enough: Some((1.0, "enough".into())),
        }
    }

    #[test]
    fn points_land_on_their_decades() {
        register().unwrap();
        let figure = figure(vec![point(10.0, 1.0), point(0.1, 10.0)]);
        let plot = layout(&figure, 100.0).unwrap();
        let [[left, above], [right, below]] =
            [[0.1, 10.0], [10.0, 1.0]].map(|at| plot.place(at).unwrap());
        assert!(left < right && above < below);
        let middle = plot.place([1.0, 1.0]).unwrap();
        assert!((middle[0] - f64::midpoint(left, right)).abs() < 1e-9);
        let image = decode(&work(&figure).unwrap());
        assert!(image.ink() > 5000);
    }

    #[test]
    fn what_is_too_small_lies_with_the_zeros_and_does_not_stretch_the_axis() {
        register().unwrap();
        let small = |error| figure(vec![point(10.0, 1.0), point(0.1, 10.0), point(error, 20.0)]);
        let [tiny, zero] = [1e-30, 0.0].map(|error| layout(&small(error), 100.0).unwrap());
        assert_eq!(tiny.errors, zero.errors);
        assert_eq!(tiny.place([1e-30, 1.0]), tiny.place([0.0, 1.0]));
        assert_eq!(tiny.errors.labels[0].text, "less");
        assert!(tiny.column(0.0) < tiny.column(0.1));
    }

    /// From above down to the first point, along its price to the next, and on to the right.
    #[test]
    fn the_front_is_a_flight_of_stairs() {
        register().unwrap();
        let figure = figure(vec![point(10.0, 1.0), point(0.1, 10.0)]);
        let plot = layout(&figure, 100.0).unwrap();
        let [a, b] = [[0.1, 10.0], [1.0, 1.0]].map(|at| plot.place(at).unwrap());
        let frame = plot.frame.inset(stairs().width / 2.0);
        let stairs = [[a[0], frame.top], a, [b[0], a[1]], b, [frame.right, b[1]]];
        assert_eq!(front(&figure, &plot), stairs);
    }

    #[test]
    fn no_data_make_it_fail() {
        let strange = [f64::NAN, f64::INFINITY, 0.0, -1.0, 1e308, 5e-324];
        let pairs = strange.iter().flat_map(|a| strange.map(|b| point(*a, b)));
        let mut all = figure(pairs.collect());
        all.least = 0.0;
        assert_eq!(work(&all).unwrap(), work(&all).unwrap());
        all.enough = Some((f64::NAN, String::new()));
        all.goals[0].error = f64::NAN;
        all.goals[0].answer = None;
        decode(&work(&all).unwrap());
        let mut nothing = figure(Vec::new());
        nothing.curves.clear();
        nothing.goals.clear();
        decode(&work(&nothing).unwrap());
    }
}
