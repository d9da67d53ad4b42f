//! The font in a PDF.

use miniz_oxide::deflate::compress_to_vec_zlib;
use pdf_writer::types::{CidFontType, FontFlags, SystemInfo, UnicodeCmap};
use pdf_writer::{Filter, Finish, Name, Rect, Ref, Str};

use super::{FONT, LEVEL, Pdf};

const CID_FONT: Ref = Ref::new(4);
const DESCRIPTOR: Ref = Ref::new(5);
const FONT_FILE: Ref = Ref::new(6);
const CMAP: Ref = Ref::new(7);
/// The name of the font, which is a part of DejaVu Sans.
const BASE_FONT: Name = Name(b"SANDBX+DejaVuSans");

impl Pdf {
    /// Embeds the glyphs that are used, with their widths and letters, so that text can be searched and copied.
    pub(super) fn write_font(&self, pdf: &mut pdf_writer::Pdf) -> Result<(), String> {
        let cut = subsetter::subset(dejavu::sans::regular(), 0, &self.remapper);
        let part = cut.map_err(|error| format!("cannot embed the font: {error}"))?;
        let info = SystemInfo {
            registry: Str(b"Adobe"),
            ordering: Str(b"Identity"),
            supplement: 0,
        };
        pdf.type0_font(FONT)
            .base_font(BASE_FONT)
            .encoding_predefined(Name(b"Identity-H"))
            .descendant_font(CID_FONT)
            .to_unicode(CMAP);
        let mut font = pdf.cid_font(CID_FONT);
        font.subtype(CidFontType::Type2).base_font(BASE_FONT);
        font.system_info(info).font_descriptor(DESCRIPTOR);
        font.default_width(600.0)
            .cid_to_gid_map_predefined(Name(b"Identity"));
        let mut widths = font.widths();
        for (&glyph, &(_, width)) in &self.letters {
            widths.same(glyph, glyph, width);
        }
        widths.finish();
        font.finish();
        pdf.font_descriptor(DESCRIPTOR)
            .name(BASE_FONT)
            .flags(FontFlags::SYMBOLIC)
            .bbox(Rect::new(-1021.0, -463.0, 1793.0, 1232.0))
            .italic_angle(0.0)
            .ascent(928.0)
            .descent(-236.0)
            .cap_height(729.0)
            .stem_v(80.0)
            .font_file2(FONT_FILE);
        let data = compress_to_vec_zlib(&part, LEVEL);
        let length = part.len() as i32;
        let mut file = pdf.stream(FONT_FILE, &data);
        file.filter(Filter::FlateDecode)
            .pair(Name(b"Length1"), length);
        file.finish();
        let mut map = UnicodeCmap::new(Name(b"Custom"), info);
        for (&glyph, &(letter, _)) in &self.letters {
            map.pair(glyph, letter);
        }
        pdf.cmap(CMAP, &map.finish());
        Ok(())
    }
}
