//! Line charts as SVG.

use std::path::Path;

use anyhow::Result;
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;

use super::{COLORS, FONT, check_name};
use crate::format::write_atomic;

/// Width and height, px.
const SIZE: (u32, u32) = (480, 320);
/// Fewer points than this are dots on their line.
const DOTS: usize = 40;
/// Most numbers under the horizontal axis.
const MOST_LABELS: usize = 12;
/// A line, with a dot at every point if they are few.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Line {
    /// What it is, where there are several.
    pub name: String,
    /// Points from left to right.
    pub points: Vec<(f64, f64)>,
    /// What it is compared with, from left to right: rings of its color.
    pub others: Vec<(f64, f64)>,
}

/// Lines over one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Above the plot.
    pub title: &'static str,
    /// Under the horizontal axis.
    pub x: &'static str,
    /// Beside the vertical axis.
    pub y: &'static str,
    /// What is drawn.
    pub lines: Vec<Line>,
    /// Whether the vertical axis is logarithmic; points that are not above 0 are then left out. Else it ends at 1.
    pub log: bool,
}

impl Chart {
    /// Writes the chart as SVG, whole or not at all.
    ///
    /// # Errors
    /// If the name of the file does not end in .svg, or it cannot be written.
    pub fn write(&self, file: &Path) -> Result<()> {
        check_name(file)?;
        Ok(write_atomic(file, self.to_svg()?.as_bytes())?)
    }

    /// The text of the SVG.
    ///
    /// # Errors
    /// If plotters refuses.
    pub fn to_svg(&self) -> Result<String> {
        let points = || {
            self.lines
                .iter()
                .flat_map(|line| line.points.iter().chain(&line.others))
                .filter(|point| !self.log || point.1 > 0.0)
        };
        let ends = |value: fn(&(f64, f64)) -> f64| {
            points().map(value).fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
        };
        let ((left, right), (bottom, top)) = (ends(|point| point.0), ends(|point| point.1));
        let (left, right) = if left <= right { (left, right) } else { (0.0, 1.0) };
        let mut svg = String::new();
        {
            let area = SVGBackend::with_string(&mut svg, SIZE).into_drawing_area();
            area.fill(&WHITE)?;
            let mut builder = ChartBuilder::on(&area);
            builder.caption(self.title, (FONT, 18)).margin(12).x_label_area_size(36).y_label_area_size(60);
            if self.log {
                let (bottom, top) = if bottom <= top { (bottom / 1.1, top * 1.1) } else { (0.1, 1.0) };
                self.draw(builder.build_cartesian_2d(left..right, (bottom..top).log_scale())?, 8)?;
            } else {
                let steps = self.lines.iter().map(|line| line.points.len()).max().unwrap_or(0).clamp(2, MOST_LABELS);
                let room = 0.05 * (right - left).min(5.0);
                let plot = builder.build_cartesian_2d(left - room..right + room, bottom.min(0.0)..1.0)?;
                self.draw(plot, steps)?;
            }
            area.present()?;
        }
        Ok(svg)
    }

    fn draw<'a, Y>(
        &self,
        mut plot: ChartContext<'a, SVGBackend<'a>, Cartesian2d<plotters::coord::types::RangedCoordf64, Y>>,
        steps: usize,
    ) -> Result<()>
    where
        Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        let digits = if plot.x_range().end <= 2.0 { 1 } else { 0 };
        plot.configure_mesh()
            .x_desc(self.x)
            .y_desc(self.y)
            .x_labels(steps)
            .x_label_formatter(&|x| format!("{x:.digits$}"))
            .y_label_formatter(&|y| if *y < 0.1 && self.log { format!("{y:.0e}") } else { format!("{y:.1}") })
            .light_line_style(TRANSPARENT)
            .draw()?;
        for (line, color) in self.lines.iter().zip(COLORS.iter().cycle()) {
            let points = || line.points.iter().copied().filter(|point| !self.log || point.1 > 0.0);
            plot.draw_series(LineSeries::new(points(), color))?
                .label(&line.name)
                .legend(move |(x, y)| PathElement::new([(x, y), (x + 16, y)], color));
            if line.points.len() < DOTS {
                plot.draw_series(points().map(|point| Circle::new(point, 3, color.filled())))?;
            }
            let others = line.others.iter().copied().filter(|point| !self.log || point.1 > 0.0);
            plot.draw_series(others.map(|point| Circle::new(point, 4, color)))?;
        }
        if self.lines.len() > 1 {
            plot.configure_series_labels().background_style(WHITE.mix(0.8)).border_style(BLACK).draw()?;
        }
        Ok(())
    }
}
