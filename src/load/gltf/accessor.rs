//! Numbers out of buffers: accessors of any component type, strided, normalized and sparse.
//!
//! Nothing of a file is trusted: every range is checked before it is read, and a count before
//! memory is taken for it.

use super::document::{Document, Reasoned};
use gltf::json::accessor::{ComponentType, sparse::Sparse};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index, buffer};

/// Where elements of some bytes each lie.
struct Elements<'a> {
    bytes: &'a [u8],
    stride: usize,
}

impl Document {
    /// How many components an element of an accessor has.
    pub(super) fn num_components(&self, index: Index<Accessor>) -> Option<usize> {
        match self.root.get(index)?.type_ {
            Checked::Valid(kind) => Some(kind.multiplicity()),
            Checked::Invalid => None,
        }
    }

    /// The elements of an accessor of `N` components: integers as they are, or, where they are
    /// normalized, from -1 or 0 to 1.
    pub(super) fn floats<const N: usize>(&self, index: Index<Accessor>) -> Reasoned<Vec<[f32; N]>> {
        let accessor = self.accessor(index)?;
        let kind = component(accessor, index)?;
        let is_normalized = accessor.normalized;
        let read = |bytes: &[u8]| float(bytes, kind, is_normalized);
        self.elements(accessor, index, kind, read)
    }

    /// The elements of an accessor of `N` unsigned integers.
    pub(super) fn integers<const N: usize>(
        &self,
        index: Index<Accessor>,
    ) -> Reasoned<Vec<[u32; N]>> {
        let accessor = self.accessor(index)?;
        let kind = component(accessor, index)?;
        if !matches!(kind, ComponentType::U8 | ComponentType::U16 | ComponentType::U32) {
            return Err(format!("accessor {index} does not hold unsigned integers"));
        }
        self.elements(accessor, index, kind, |bytes| integer(bytes, kind))
    }

    fn accessor(&self, index: Index<Accessor>) -> Reasoned<&Accessor> {
        self.root.get(index).ok_or_else(|| format!("accessor {index} does not exist"))
    }

    fn elements<T: Copy + Default, const N: usize>(
        &self,
        accessor: &Accessor,
        index: Index<Accessor>,
        kind: ComponentType,
        read: impl Fn(&[u8]) -> T,
    ) -> Reasoned<Vec<[T; N]>> {
        if self.num_components(index) != Some(N) {
            return Err(format!("accessor {index} needs elements of {N} components"));
        }
        let count = accessor.count.0;
        // Without a buffer behind it, a number in the file alone would say how much memory to take.
        if count > self.most_elements {
            return Err(format!(
                "accessor {index} has {count} elements, more than max_triangles allows"
            ));
        }
        let (size, count) = (kind.size() * N, count as usize);
        let offset = accessor.byte_offset.map_or(0, |offset| offset.0);
        let element =
            |bytes: &[u8]| std::array::from_fn(|i| read(&bytes[i * kind.size()..][..kind.size()]));
        let mut values = match accessor.buffer_view {
            Some(view) => self
                .view_elements(view, offset, size, count)
                .map_err(|reason| format!("accessor {index} {reason}"))?
                .iter(size, count)
                .map(element)
                .collect(),
            // Zeros, of as many vertices as other accessors have in the buffers.
            None if count <= self.buffers.iter().map(Vec::len).sum() => {
                vec![[T::default(); N]; count]
            }
            None => return Err(format!("accessor {index} has {count} elements of no bytes")),
        };
        if let Some(sparse) = &accessor.sparse {
            self.replace(&mut values, sparse, size, element)
                .map_err(|reason| format!("accessor {index} {reason}"))?;
        }
        Ok(values)
    }

    /// Puts the elements of a sparse accessor in their places.
    fn replace<E>(
        &self,
        values: &mut [E],
        sparse: &Sparse,
        size: usize,
        element: impl Fn(&[u8]) -> E,
    ) -> Reasoned<()> {
        let Checked::Valid(kind) = sparse.indices.component_type else {
            return Err("has sparse indices of an unknown type".into());
        };
        let count = usize::try_from(sparse.count.0).unwrap_or(usize::MAX);
        let (at, of) = (&sparse.indices, &sparse.values);
        let width = kind.0.size();
        let places = self.view_elements(at.buffer_view, at.byte_offset.0, width, count)?;
        let elements = self.view_elements(of.buffer_view, of.byte_offset.0, size, count)?;
        for (place, bytes) in places.iter(width, count).zip(elements.iter(size, count)) {
            let place = integer(place, kind.0) as usize;
            *values.get_mut(place).ok_or("has a sparse index beyond its end")? = element(bytes);
        }
        Ok(())
    }

    /// Elements of `size` bytes from `offset` of a view on.
    fn view_elements(
        &self,
        view: Index<buffer::View>,
        offset: u64,
        size: usize,
        count: usize,
    ) -> Reasoned<Elements<'_>> {
        let stride = self.root.get(view).and_then(|view| view.byte_stride);
        let stride = stride.map_or(size, |stride| stride.0);
        let bytes = self.view(view)?;
        let beyond = || format!("reaches beyond the end of buffer view {view}");
        let bytes =
            usize::try_from(offset).ok().and_then(|at| bytes.get(at..)).ok_or_else(beyond)?;
        if stride < size {
            return Err(format!("has elements of {size} bytes, more than the stride {stride}"));
        }
        let needed = (count.max(1) - 1).checked_mul(stride).and_then(|n| n.checked_add(size));
        if count > 0 && needed.is_none_or(|needed| needed > bytes.len()) {
            return Err(beyond());
        }
        Ok(Elements { bytes, stride })
    }

    /// The bytes of a buffer view.
    pub(super) fn view(&self, index: Index<buffer::View>) -> Reasoned<&[u8]> {
        let view =
            self.root.get(index).ok_or_else(|| format!("buffer view {index} does not exist"))?;
        let buffer = self.buffers.get(view.buffer.value());
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let end = start.checked_add(view.byte_length.0);
        let range = end.and_then(|end| Some(start.try_into().ok()?..end.try_into().ok()?));
        let bytes = buffer
            .zip(range)
            .and_then(|(buffer, range)| buffer.get::<std::ops::Range<usize>>(range));
        bytes.ok_or_else(|| format!("buffer view {index} reaches beyond the end of its buffer"))
    }
}

impl<'a> Elements<'a> {
    /// `count` elements of `size` bytes, which were checked to be there.
    fn iter(self, size: usize, count: usize) -> impl Iterator<Item = &'a [u8]> {
        (0..count).map(move |i| &self.bytes[i * self.stride..][..size])
    }
}

fn component(accessor: &Accessor, index: Index<Accessor>) -> Reasoned<ComponentType> {
    match accessor.component_type {
        Checked::Valid(kind) => Ok(kind.0),
        Checked::Invalid => Err(format!("accessor {index} has components of an unknown type")),
    }
}

fn integer(bytes: &[u8], kind: ComponentType) -> u32 {
    match (kind, bytes) {
        (ComponentType::U16, &[a, b, ..]) => u16::from_le_bytes([a, b]).into(),
        (ComponentType::U32, &[a, b, c, d, ..]) => u32::from_le_bytes([a, b, c, d]),
        (_, &[a, ..]) => a.into(),
        _ => 0,
    }
}

fn float(bytes: &[u8], kind: ComponentType, is_normalized: bool) -> f32 {
    let signed = |value: f32, most: f32| {
        if is_normalized { (value / most).max(-1.0) } else { value }
    };
    match (kind, bytes) {
        (ComponentType::F32, &[a, b, c, d]) => f32::from_le_bytes([a, b, c, d]),
        (ComponentType::I8, &[a]) => signed(a.cast_signed().into(), 127.0),
        (ComponentType::I16, &[a, b]) => signed(i16::from_le_bytes([a, b]).into(), 32767.0),
        (ComponentType::U8, _) => signed(integer(bytes, kind) as f32, 255.0),
        (ComponentType::U16, _) => signed(integer(bytes, kind) as f32, 65535.0),
        _ => integer(bytes, kind) as f32,
    }
}
