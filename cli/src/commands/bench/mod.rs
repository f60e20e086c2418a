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
use crate::timing::draw_repeated;
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
fn with_options(filter: Filter) -> Filter {
    match filter {
        Filter::Parallax(_) => Filter::Parallax(Rays { samples: 1 }),
        // Each is named, so that a new filter cannot be forgotten here.
        Filter::Nearest
        | Filter::Bilinear
        | Filter::Trilinear(_)
        | Filter::Ewa(_)
        | Filter::Visible(_)
        | Filter::Horizon(_)
        | Filter::Truth(_) => filter,
    }
}

/// What is to be measured.
struct Job<'a> {
    options: &'a BenchOptions,
    filters: Vec<Filter>,
    progress: &'a Progress,
}

impl Job<'_> {
    fn run(&self) -> Result<Vec<Case>, Refusal> {
        let asked = &self.options.scenes;
        let is_asked = |scene: &Standard| asked.is_empty() || asked.contains(scene);
        let scenes: Vec<_> = SCENES.iter().filter(|(_, scene, _)| is_asked(scene)).collect();
        self.progress.stage("making the scenes' textures");
        let stones = Stones::new();
        self.progress.count((scenes.len() * (self.filters.len() + 1)) as u64);
        let mut cases = Vec::new();
        for &&(name, standard, _) in &scenes {
            self.measure(name, &stones, standard, &mut cases)?;
        }
        Ok(cases)
    }

    /// Measures all filters on a scene.
    fn measure(
        &self,
        name: &str,
        stones: &Stones,
        standard: Standard,
        cases: &mut Vec<Case>,
    ) -> Result<(), Refusal> {
        let Self { options, filters, progress } = self;
        let settings = |filter, [width, height]: [u32; 2]| Settings {
            width,
            height,
            filter,
            msaa: 1,
            cull_back_faces: true,
            parallax: standard != Standard::Triangles,
            ..Settings::default()
        };
        progress.stage(format!("{name}: the truth"));
        let truth = Filter::Truth(Rays { samples: options.truth_samples });
        let mut renderer =
            Renderer::new(stones.scene(standard), settings(truth, options.truth_size))?;
        let truth = Picture::from(&renderer.render());
        progress.step();
        for filter in filters {
            progress.stage(format!("{name}: {}", word(filter)));
            renderer.set_settings(settings(*filter, options.truth_size))?;
            let psnr_db = compare(&truth, &Picture::from(&renderer.render()))?.psnr_db;
            renderer.set_settings(settings(*filter, options.size))?;
            let (_, took): (Frame<[u8; 4]>, _) = draw_repeated(&mut renderer, options.repeat);
            cases.push(Case::new([name, word(filter)], &took, psnr_db));
            progress.step();
        }
        Ok(())
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
