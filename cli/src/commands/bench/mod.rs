//! `basrelief bench`: every filter on the standard scenes, timed and held against the truth.

mod against;
mod report;
mod scenes;
mod table;

use crate::machine::Machine;
use crate::options::bench::{BenchOptions, SCENES, Standard};
use crate::options::choices::{Words, word};
use crate::options::threads::thread_pool;
use crate::output;
use crate::progress::Progress;
use crate::refusal::Refusal;
use crate::timing::{self, Took, draw_repeated};
use against::Earlier;
use basrelief::metrics::{Picture, compare};
use basrelief::{Filter, Frame, Rays, Renderer, Settings};
use report::{Case, Report};
use scenes::Stones;
use std::process::ExitCode;

/// Draws and measures what the options name.
pub(crate) fn run(options: &BenchOptions) -> Result<ExitCode, Refusal> {
    // All that can be refused without work is refused before the work.
    let filters = filters(&options.filters)?;
    let pool = thread_pool(options.threads)?;
    let mut report = pool.install(|| Report::new(Machine::here(), options));
    let earlier = match &options.against {
        Some(path) => Some(Earlier::read(path, &report)?),
        None => None,
    };
    if let Some(path) = &options.json {
        output::check(path)?;
    }
    let progress = Progress::new(options.quiet);
    if let Some(difference) = earlier.as_ref().and_then(|earlier| earlier.difference(&report)) {
        progress.warn(&difference);
    }
    let job = Job { options, filters, progress: &progress };
    report.cases = pool.install(|| job.run())?;
    if let Some(earlier) = &earlier {
        earlier.compare(&mut report.cases);
    }
    if let Some(path) = &options.json {
        output::write(path, &report.json()?)?;
    }
    if !options.json.as_deref().is_some_and(output::is_stdout) {
        output::print(table::text(&report).as_bytes())?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The filters that are asked for, each with the options that it is measured with.
fn filters(asked: &[Filter]) -> Result<Vec<Filter>, Refusal> {
    let is_truth = |filter: &Filter| filter.is_same_choice(&Filter::Truth(Rays::default()));
    if asked.iter().any(is_truth) {
        return Err("--filters: truth is what the others are held against".into());
    }
    let all = Filter::ALL.into_iter().filter(|filter| !is_truth(filter));
    let is_asked =
        |filter: &Filter| asked.is_empty() || asked.iter().any(|one| one.is_same_choice(filter));
    Ok(all.filter(is_asked).map(with_options).collect())
}

/// The default options, but one ray a pixel where a filter takes many, as graphics cards do.
fn with_options(mut filter: Filter) -> Filter {
    filter.options_mut().samples.into_iter().for_each(|samples| *samples = 1);
    filter
}

/// What is to be measured.
struct Job<'a> {
    options: &'a BenchOptions,
    filters: Vec<Filter>,
    progress: &'a Progress,
}

/// A scene on its way.
struct Subject {
    name: &'static str,
    standard: Standard,
    renderer: Renderer,
    /// For each filter its quality, and what its frames took.
    found: Vec<(f64, Vec<Took>)>,
}

impl Job<'_> {
    /// Measures everything. Frames are timed in rounds over all scenes and filters, so that what
    /// else the machine does for a while is seen in the spread and does not fall on one filter.
    fn run(&self) -> Result<Vec<Case>, Refusal> {
        let asked = &self.options.scenes;
        let is_asked = |scene: &Standard| asked.is_empty() || asked.contains(scene);
        let scenes: Vec<_> = SCENES.iter().filter(|(_, scene, _)| is_asked(scene)).collect();
        self.progress.stage("making the scenes' textures");
        let stones = Stones::new();
        let num_frames = (self.options.repeat as usize + 1) * self.filters.len() + 1;
        self.progress.count((scenes.len() * num_frames) as u64);
        let subject = |&&(name, standard, _): &&_| self.judged(name, standard, &stones);
        let mut subjects: Vec<_> = scenes.iter().map(subject).collect::<Result<_, _>>()?;
        for _ in 0..self.options.repeat {
            subjects.iter_mut().try_for_each(|subject| self.time(subject))?;
        }
        Ok(subjects.into_iter().flat_map(|subject| self.cases(subject)).collect())
    }

    /// A scene with every filter held against the truth.
    fn judged(
        &self,
        name: &'static str,
        standard: Standard,
        stones: &Stones,
    ) -> Result<Subject, Refusal> {
        let Self { options, filters, progress } = self;
        progress.stage(format!("{name}: the truth"));
        let settings = |filter| settings(standard, filter, options.truth_size);
        let truth = Filter::Truth(Rays { samples: options.truth_samples });
        let mut renderer = Renderer::new(stones.scene(standard), settings(truth))?;
        let truth = Picture::from(&renderer.render());
        progress.step();
        let mut found = Vec::new();
        for filter in filters {
            progress.stage(format!("{name}: quality of {}", word(filter)));
            renderer.set_settings(settings(*filter))?;
            let psnr_db = compare(&truth, &Picture::from(&renderer.render()))?.psnr_db;
            found.push((psnr_db, Vec::new()));
            progress.step();
        }
        Ok(Subject { name, standard, renderer, found })
    }

    /// Times a frame of every filter on a scene.
    fn time(&self, subject: &mut Subject) -> Result<(), Refusal> {
        for (filter, (_, took)) in self.filters.iter().zip(&mut subject.found) {
            self.progress.stage(format!("{}: time of {}", subject.name, word(filter)));
            let settings = settings(subject.standard, *filter, self.options.size);
            subject.renderer.set_settings(settings)?;
            let (_, one): (Frame<[u8; 4]>, _) = draw_repeated(&mut subject.renderer, 1);
            took.extend(one);
            self.progress.step();
        }
        Ok(())
    }

    fn cases(&self, subject: Subject) -> Vec<Case> {
        let found = self.filters.iter().zip(subject.found);
        let case = |(filter, (psnr_db, mut took)): (&Filter, (f64, Vec<Took>))| {
            timing::sort(&mut took);
            Case::new([subject.name, word(filter)], &took, psnr_db)
        };
        found.map(case).collect()
    }
}

/// How a scene is drawn: a sample a pixel, as graphics cards are measured.
fn settings(standard: Standard, filter: Filter, [width, height]: [u32; 2]) -> Settings {
    Settings {
        width,
        height,
        filter,
        msaa: 1,
        cull_back_faces: true,
        parallax: standard != Standard::Triangles,
        ..Settings::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_filter_is_measured_but_the_truth() {
        let all = filters(&[]).unwrap();
        assert_eq!(all.len(), Filter::ALL.len() - 1);
        assert!(all.contains(&Filter::Parallax(Rays { samples: 1 })));
        let two = [Filter::Nearest, Filter::default()];
        assert_eq!(filters(&two).unwrap(), two);
        assert!(filters(&[Filter::Truth(Rays::default())]).is_err());
    }
}
