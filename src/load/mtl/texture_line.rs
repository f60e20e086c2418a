//! The grammar of a texture line: `[-option value…] file name [-option value…]`.
//!
//! Options may stand before or after the name, the name may hold spaces, and backslashes are turned
//! into slashes.

use crate::decode::Channel;

/// A texture line taken apart.
#[derive(Clone, Debug, PartialEq)]
pub(in crate::load) struct TextureLine {
    /// The file's name with forward slashes, as far as it is relative to the file that names it.
    pub(in crate::load) name: String,
    /// `-bm`: relief depth, or strength of a normal map.
    pub(in crate::load) bump: Option<f32>,
    /// `-s`: repeats along u and v.
    pub(in crate::load) scale: [f32; 2],
    /// `-o`: shift along u and v, in repeats.
    pub(in crate::load) offset: [f32; 2],
    /// `-mm`: base and gain.
    pub(in crate::load) range: [f32; 2],
    /// `-clamp on`.
    pub(in crate::load) is_clamped: bool,
    /// `-imfchan`.
    pub(in crate::load) channel: Option<Channel>,
    /// Options that have no effect here, by name.
    pub(in crate::load) unsupported: Vec<String>,
}

impl Default for TextureLine {
    fn default() -> Self {
        Self {
            name: String::new(),
            bump: None,
            scale: [1.0; 2],
            offset: [0.0; 2],
            range: [0.0, 1.0],
            is_clamped: false,
            channel: None,
            unsupported: Vec::new(),
        }
    }
}

impl TextureLine {
    /// Reads what follows the keyword. An empty name is left to the caller.
    ///
    /// # Errors
    /// Names the option whose value is wrong.
    pub(in crate::load) fn parse(text: &str) -> Result<Self, String> {
        let words: Vec<&str> = text.split_whitespace().collect();
        let mut line = Self::default();
        let mut first = 0;
        // The last word before a trailing option is the name: an option never takes it.
        while first + 1 < words.len() && is_option(words[first]) {
            first += line.take_option(&words[first..words.len() - 1])?;
        }
        let end =
            (first + 1..words.len()).find(|&i| is_all_options(&words[i..])).unwrap_or(words.len());
        let mut next = end;
        while next < words.len() {
            next += line.take_option(&words[next..])?;
        }
        line.name = name_between(text, words.get(first..end).unwrap_or_default());
        Ok(line)
    }

    /// Takes one option and its values off the front; returns how many words these are.
    fn take_option(&mut self, words: &[&str]) -> Result<usize, String> {
        let option = words[0].to_ascii_lowercase();
        let values = &words[1..=num_values(&option, &words[1..])];
        let number = |i: usize| match values.get(i).map(|word| word.parse::<f32>()) {
            Some(Ok(number)) if number.is_finite() => Ok(number),
            Some(_) => Err(format!("'{}' is not a finite number", values[i])),
            None => Err(format!("option {option} needs {} number(s)", i + 1)),
        };
        let second = |fallback: f32| if values.len() > 1 { number(1) } else { Ok(fallback) };
        match option.as_str() {
            "-bm" => self.bump = Some(number(0)?),
            "-s" => self.scale = [number(0)?, second(1.0)?],
            "-o" => self.offset = [number(0)?, second(0.0)?],
            "-mm" => self.range = [number(0)?, number(1)?],
            "-clamp" => {
                self.is_clamped =
                    values.first().is_some_and(|word| word.eq_ignore_ascii_case("on"));
            }
            "-imfchan" => {
                self.channel = Some(channel(values.first().copied().unwrap_or_default())?);
            }
            _ => self.unsupported.push(option.clone()),
        }
        Ok(1 + values.len())
    }
}

/// The text of `words`, with the spaces between them as they are in `text`.
fn name_between(text: &str, words: &[&str]) -> String {
    let (Some(first), Some(last)) = (words.first(), words.last()) else {
        return String::new();
    };
    let start = first.as_ptr() as usize - text.as_ptr() as usize;
    let end = last.as_ptr() as usize - text.as_ptr() as usize + last.len();
    text[start..end].trim_matches('"').replace('\\', "/")
}

fn is_option(word: &str) -> bool {
    let letters = word.strip_prefix('-').unwrap_or_default();
    !letters.is_empty() && letters.chars().all(|c| c.is_ascii_alphabetic())
}

/// Whether `words` are options that the format knows, and their values, to the end.
fn is_all_options(words: &[&str]) -> bool {
    let mut next = 0;
    while next < words.len() {
        let option = words[next].to_ascii_lowercase();
        if matches!(values_of(&option), Values::Unknown) {
            return false;
        }
        next += 1 + num_values(&option, &words[next + 1..]);
    }
    true
}

/// What may follow an option.
enum Values {
    /// So many numbers at most.
    Numbers(usize),
    /// `on` or `off`.
    Switch,
    Word,
    /// Nothing is known of the option.
    Unknown,
}

fn values_of(option: &str) -> Values {
    match option {
        "-s" | "-o" | "-t" => Values::Numbers(3),
        "-mm" => Values::Numbers(2),
        "-bm" | "-boost" | "-texres" => Values::Numbers(1),
        "-clamp" | "-blendu" | "-blendv" | "-cc" => Values::Switch,
        "-imfchan" | "-type" | "-colorspace" => Values::Word,
        _ => Values::Unknown,
    }
}

/// How many of `words` are values of the option before them.
fn num_values(option: &str, words: &[&str]) -> usize {
    match values_of(option) {
        Values::Numbers(most) => {
            words.iter().take(most).take_while(|word| word.parse::<f32>().is_ok()).count()
        }
        Values::Switch => usize::from(words.first().is_some_and(|word| is_switch(word))),
        Values::Word => words.len().min(1),
        Values::Unknown => 0,
    }
}

fn is_switch(word: &str) -> bool {
    word.eq_ignore_ascii_case("on") || word.eq_ignore_ascii_case("off")
}

fn channel(word: &str) -> Result<Channel, String> {
    match word.to_ascii_lowercase().as_str() {
        // A depth image has its depth in every channel.
        "r" | "z" => Ok(Channel::Red),
        "g" => Ok(Channel::Green),
        "b" => Ok(Channel::Blue),
        "m" => Ok(Channel::Matte),
        "l" => Ok(Channel::Luma),
        _ => Err(format!("option -imfchan takes r, g, b, m, l or z, not '{word}'")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> TextureLine {
        TextureLine::parse(text).expect("a valid line")
    }

    #[test]
    fn options_before_and_after_the_name() {
        for text in
            ["-bm 0.1 -clamp on a b.png", "a b.png -bm 0.1 -clamp on", "-bm 0.1 a b.png -clamp on"]
        {
            let line = parse(text);
            assert_eq!(
                (line.name.as_str(), line.bump, line.is_clamped),
                ("a b.png", Some(0.1), true),
                "{text}"
            );
        }
    }

    #[test]
    fn scale_offset_range_channel() {
        let line = parse("-s 2 3 1 -o 0.5 0.25 -mm 0.1 0.8 -imfchan G h.png");
        assert_eq!((line.scale, line.offset, line.range), ([2.0, 3.0], [0.5, 0.25], [0.1, 0.8]));
        assert_eq!((line.channel, line.name.as_str()), (Some(Channel::Green), "h.png"));
        assert_eq!(parse("-s 4 h.png").scale, [4.0, 1.0]);
    }

    #[test]
    fn unsupported_options_are_skipped_and_named() {
        let line = parse(
            "-blendu off -blendv on -boost 2 -t 1 1 1 -texres 256 -type sphere -colorspace sRGB x.png",
        );
        assert_eq!(line.name, "x.png");
        assert_eq!(
            line.unsupported,
            ["-blendu", "-blendv", "-boost", "-t", "-texres", "-type", "-colorspace"]
        );
        assert_eq!(parse("-frob x.png").unsupported, ["-frob"]);
    }

    #[test]
    fn names_keep_spaces_and_lose_backslashes() {
        assert_eq!(parse(r"tex\my  stone - v2.png").name, "tex/my  stone - v2.png");
        assert_eq!(parse("\"quoted name.png\"").name, "quoted name.png");
        assert_eq!(parse("-o 1 2 3").name, "3", "the last word is the name");
        assert_eq!(parse("-bm.png").name, "-bm.png");
        assert_eq!(parse("").name, "");
    }

    #[test]
    fn wrong_values_are_refused() {
        for text in
            ["-bm x.png y.png", "-mm 1 x.png", "-imfchan q x.png", "-bm nan x.png", "x.png -s inf"]
        {
            assert!(TextureLine::parse(text).is_err(), "{text}");
        }
    }
}
