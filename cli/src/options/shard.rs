//! Which of many frames this process draws: every n-th of them, by options or by what a cluster
//! says of the task.

use crate::options::values::digits;
use crate::refusal::Refusal;

/// One of several processes that share the frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shard {
    /// From 0.
    index: u32,
    count: u32,
}

impl Shard {
    /// From `2/4`, the second of four.
    pub(crate) fn parse(text: &str) -> Result<Self, String> {
        let sides = text.split_once('/').map(|(i, n)| (digits(i), digits(n)));
        match sides {
            Some((Some(i), Some(count))) if (1..=count).contains(&i) => {
                Ok(Self { index: i - 1, count })
            }
            _ => Err("is not I/N with I from 1 to N, such as 2/4".into()),
        }
    }

    /// What the environment says, read by `get`: that of a Kubernetes Indexed Job where `shards`
    /// gives its completions, else that of a Slurm array; with the cluster's name.
    pub(crate) fn from_environment(
        shards: Option<u32>,
        get: impl Fn(&str) -> Option<String>,
    ) -> Result<Option<(Self, &'static str)>, Refusal> {
        let number = |name: &str| {
            get(name).map(|text| digits(&text).ok_or(format!("{name}={text} is not a number")))
        };
        let pod = number("JOB_COMPLETION_INDEX").transpose()?;
        match (pod, shards) {
            (Some(index), Some(count)) if index < count => return Ok(Some((Self { index, count }, "Kubernetes Job"))),
            (Some(index), Some(count)) => Err(format!("--shards {count}: JOB_COMPLETION_INDEX is {index}")),
            (None, Some(_)) => {
                Err("--shards: JOB_COMPLETION_INDEX is not set; --shard I/N says which shard this is".into())
            }
            (Some(_), None) => {
                Err("JOB_COMPLETION_INDEX is set: --shards N must say how many completions the job has, or \
                                    --shard 1/1 that all frames are meant"
                    .into())
            }
            (None, None) => Ok(()),
        }?;
        let Some(id) = number("SLURM_ARRAY_TASK_ID").transpose()? else { return Ok(None) };
        let [min, max, count, step] = ["MIN", "MAX", "COUNT", "STEP"]
            .map(|name| number(&format!("SLURM_ARRAY_TASK_{name}")).transpose());
        let (min, max, step) = (min?.unwrap_or(id), max?, step?.unwrap_or(1).max(1));
        let Some(count) = count? else {
            return Err(
                "SLURM_ARRAY_TASK_ID is set, but not SLURM_ARRAY_TASK_COUNT: --shard I/N says which shard this is"
                    .into(),
            );
        };
        let is_even = max.is_none_or(|max| max >= min && (max - min) / step + 1 == count);
        match id.checked_sub(min) {
            Some(offset) if is_even && offset % step == 0 && offset / step < count => {
                Ok(Some((Self { index: offset / step, count }, "Slurm array")))
            }
            _ => Err(format!(
                "the Slurm array of {count} tasks from {min} has gaps: --shard I/N says which shard this is"
            )
            .into()),
        }
    }

    /// Those of `items` that are this shard's.
    pub(crate) fn pick<T>(self, items: Vec<T>) -> Vec<T> {
        items.into_iter().skip(self.index as usize).step_by(self.count as usize).collect()
    }
}

impl std::fmt::Display for Shard {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        write!(f, "{}/{}", self.index + 1, self.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn environment(shards: Option<u32>, variables: &str) -> Result<Option<String>, Refusal> {
        let get = |name: &str| {
            let mut pairs = variables.split_whitespace().filter_map(|pair| pair.split_once('='));
            pairs.find(|(key, _)| *key == name).map(|(_, value)| value.to_owned())
        };
        Shard::from_environment(shards, get).map(|found| found.map(|(shard, _)| shard.to_string()))
    }

    fn slurm(numbers: [u32; 5]) -> String {
        let names = ["ID", "MIN", "MAX", "COUNT", "STEP"];
        names
            .iter()
            .zip(numbers)
            .map(|(name, number)| format!("SLURM_ARRAY_TASK_{name}={number} "))
            .collect()
    }

    #[test]
    fn shards_are_all_of_it_once() {
        for count in 1..=7 {
            let shard = |i| Shard::parse(&format!("{i}/{count}")).unwrap();
            let mut all: Vec<u32> =
                (1..=count).flat_map(|i| shard(i).pick((0..20).collect())).collect();
            all.sort_unstable();
            assert_eq!(all, (0..20).collect::<Vec<_>>());
        }
        assert!(
            ["0/4", "5/4", "1", "/4", "1/", "-1/4", "1/0", "a/b"]
                .iter()
                .all(|bad| Shard::parse(bad).is_err())
        );
    }

    #[test]
    fn clusters_say_which_shard_this_is() {
        assert_eq!(environment(None, ""), Ok(None));
        for (numbers, shard) in
            [([0, 0, 3, 4, 1], "1/4"), ([8, 5, 8, 4, 1], "4/4"), ([20, 0, 30, 4, 10], "3/4")]
        {
            assert_eq!(environment(None, &slurm(numbers)), Ok(Some(shard.into())));
        }
        assert_eq!(environment(Some(5), "JOB_COMPLETION_INDEX=2"), Ok(Some("3/5".into())));
        // A pod within a Slurm allocation: the count that is given belongs to the pod.
        let both = slurm([0, 0, 3, 4, 1]) + "JOB_COMPLETION_INDEX=2";
        assert_eq!(environment(Some(5), &both), Ok(Some("3/5".into())));
    }

    #[test]
    fn clusters_that_leave_it_open_are_refused() {
        let gaps = slurm([7, 1, 9, 3, 1]);
        for (shards, variables) in [
            (None, "JOB_COMPLETION_INDEX=2"),
            (Some(2), "JOB_COMPLETION_INDEX=2"),
            (Some(2), "JOB_COMPLETION_INDEX=x"),
            (Some(2), ""),
            (None, "SLURM_ARRAY_TASK_ID=1"),
            (None, "SLURM_ARRAY_TASK_ID=one"),
            (None, gaps.as_str()),
        ] {
            let refusal = environment(shards, variables).unwrap_err().to_string();
            assert!(
                refusal.contains("--shard") || refusal.contains("is not a number"),
                "{refusal}"
            );
        }
    }
}
