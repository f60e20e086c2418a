//! URIs of buffers and images: data within the URI, or the name of a file.

use base64::Engine as _;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

/// Base64 as writers have it, with or without padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The bytes of a `data:` URI; `None` where it is no such URI.
pub(super) fn data(uri: &str) -> Option<Result<Vec<u8>, &'static str>> {
    let scheme = uri.get(..5)?;
    if !scheme.eq_ignore_ascii_case("data:") {
        return None;
    }
    let Some((kind, text)) = uri[5..].split_once(',') else {
        return Some(Err("has a data URI without data"));
    };
    Some(if kind.ends_with(";base64") {
        BASE64.decode(text).map_err(|_| "has a data URI that is no base64")
    } else {
        Ok(unescaped(text))
    })
}

/// The name of a file, without escapes.
pub(super) fn file_name(uri: &str) -> String {
    String::from_utf8_lossy(&unescaped(uri)).into_owned()
}

/// Text whose `%20` and the like are bytes.
fn unescaped(text: &str) -> Vec<u8> {
    let digit = |byte: u8| char::from(byte).to_digit(16);
    let mut bytes = Vec::with_capacity(text.len());
    let mut left = text.as_bytes();
    while let [first, rest @ ..] = left {
        left = rest;
        let mut byte = *first;
        if let (b'%', [high, low, after @ ..]) = (*first, rest)
            && let Some((high, low)) = digit(*high).zip(digit(*low))
        {
            byte = (high * 16 + low) as u8;
            left = after;
        }
        bytes.push(byte);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn escapes_are_bytes_and_what_is_no_escape_stays() {
        assert_eq!(file_name("a%20b%C3%A4.png"), "a bä.png");
        assert_eq!(file_name("100%_%zz%2"), "100%_%zz%2");
    }

    #[test]
    fn data_is_found_with_and_without_padding() {
        for text in ["data:application/octet-stream;base64,AQI=", "data:;base64,AQI"] {
            assert_eq!(data(text), Some(Ok(vec![1, 2])));
        }
        assert_eq!(data("DATA:,a%20b"), Some(Ok(b"a b".to_vec())));
        assert_eq!(data("data.bin"), None);
        assert!(data("data:;base64").unwrap().is_err() && data("data:;base64,*").unwrap().is_err());
    }
}
