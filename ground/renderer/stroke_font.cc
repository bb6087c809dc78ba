#include "ground/renderer/stroke_font.h"

#include <algorithm>
#include <array>

namespace isotherm {
namespace {

// The letters are our own, drawn on a grid in which a capital is 18 high. A stroke is a list of
// points, each two digits of base 36 (0-9, a-z): x from the letter's left, y upwards from the
// lowest descender, so that the baseline is at 6, small letters reach 18 (i) and capitals 24 (o).
// Strokes are separated by spaces. The points are joined by straight lines; after '~' they pull a
// curve that begins at the first and ends at the last (a quadratic B-spline), after '@' one that is
// closed.
struct Glyph {
  int width = 0;
  std::string_view strokes;
};

// In the units in which the strokes below are written.
constexpr double kCapitalHeight = 18.0;
constexpr double kBaseline = 6.0;
constexpr double kSpacing = 6.0;  // Between letters.
constexpr int kCurvePieces = 5;   // Of which a curve between two points is made.
constexpr char kFirst = ' ';
constexpr std::string_view kDegree = "\u00B0";
constexpr Glyph kDegreeGlyph = {6, "@0i6i6o0o"};

// clang-format off
constexpr std::array<Glyph, 95> kGlyphs = {{
    {4, ""},  // space
    {0, "0o0c 0606"},  // !
    {4, "0o0j 4o4j"},  // "
    {13, "265o 86bo 0bcb 1idi"},  // #
    {12, "~ckao6o0o0gcec666260a 6r63"},  // $
    {14, "@0h6h6o0o @86e6ed8d 06eo"},  // %
    {14, "~e62i2o9o9i0e06a6de"},  // &
    {0, "0o0j"},  // '
    {4, "~4q0l0943"},  // (
    {4, "~0q4l4903"},  // )
    {6, "3o3g 0m6i 6m0i"},  // *
    {12, "6j67 0dcd"},  // +
    {1, "1703"},  // ,
    {9, "0d9d"},  // -
    {0, "0606"},  // .
    {11, "04bp"},  // /
    {12, "@06c6co0o"},  // 0
    {12, "3k7o76"},  // 1
    {12, "~1j1o6ococh8d06 06c6"},  // 2
    {12, "~1k2o6obobf5f ~5fcfc666160a"},  // 3
    {12, "969o0bcb"},  // 4
    {12, "bo1o0g ~0g2i6icic666160a"},  // 5
    {12, "@06c6ch0h ~bo3o0j0b"},  // 6
    {12, "0oco46"},  // 7
    {12, "@1fbfbo1o @06c6cf0f"},  // 8
    {12, "@0dcdco0o ~1696cbcj"},  // 9
    {0, "0606 0h0h"},  // :
    {1, "1h1h 1703"},  // ;
    {12, "ck0dc6"},  // <
    {12, "0gcg 0aca"},  // =
    {12, "0kcd06"},  // >
    {10, "~0k0o5oaoaj5g5b 5656"},  // ?
    {16, "@5ababi5i ~bibafagfgo0o04d4"},  // @
    {14, "067oe6 2ccc"},  // A
    {13, "060o ~0o5obobf5f0f ~0f6fdfd66606"},  // B
    {13, "~djbo7o0o0676b6db"},  // C
    {13, "060o ~0o6odod66606"},  // D
    {11, "bo0o06b6 0f9f"},  // E
    {11, "bo0o06 0f9f"},  // F
    {13, "~djbo7o0o0676d6dd 8ddd"},  // G
    {13, "060o d6do 0fdf"},  // H
    {0, "060o"},  // I
    {9, "~9o9g96060b"},  // J
    {13, "060o do0b 5gd6"},  // K
    {10, "0o06a6"},  // L
    {16, "060o8agog6"},  // M
    {13, "060od6do"},  // N
    {14, "@06e6eo0o"},  // O
    {13, "060o ~0o6odode6e0e"},  // P
    {14, "@06e6eo0o 8be4"},  // Q
    {13, "060o ~0o6odode6e0e 6ed6"},  // R
    {12, "~ckao6o0o0gcec666260a"},  // S
    {12, "0oco 6o66"},  // T
    {13, "~0o0g06d6dgdo"},  // U
    {14, "0o76eo"},  // V
    {18, "0o469ke6io"},  // W
    {13, "06do 0od6"},  // X
    {14, "0o7eeo 7e76"},  // Y
    {13, "0odo06d6"},  // Z
    {4, "4r0r0343"},  // [
    {11, "0pb4"},  // backslash
    {4, "0r4r4303"},  // ]
    {10, "0h5oah"},  // ^
    {12, "03c3"},  // _
    {3, "0o3k"},  // `
    {10, "@06a6ai0i aia6"},  // a
    {10, "0o06 @06a6ai0i"},  // b
    {10, "~af9i5i0i065696a9"},  // c
    {10, "aoa6 @06a6ai0i"},  // d
    {10, "0cac ~acai0i066696a9"},  // e
    {7, "~7o3o3i36 0i6i"},  // f
    {10, "@06a6ai0i ~aia6a0501003"},  // g
    {10, "0o06 ~0c0iaiaca6"},  // h
    {0, "060i 0n0n"},  // i
    {3, "~3i363000 3n3n"},  // j
    {10, "0o06 9i0a 3da6"},  // k
    {3, "~0o0a0636"},  // l
    {16, "0i06 ~0c0i8i8c86 ~8c8igigcg6"},  // m
    {10, "0i06 ~0c0iaiaca6"},  // n
    {10, "@06a6ai0i"},  // o
    {10, "0i00 @06a6ai0i"},  // p
    {10, "aia0 @06a6ai0i"},  // q
    {7, "0i06 ~0c0i7i"},  // r
    {9, "~9f8i5i0i0d9b96461609"},  // s
    {7, "~3m3a3676 0i6i"},  // t
    {10, "~0i0c06a6ac aia6"},  // u
    {10, "0i56ai"},  // v
    {14, "0i467fa6ei"},  // w
    {10, "06ai 0ia6"},  // x
    {10, "0i56 ai20"},  // y
    {10, "0iai06a6"},  // z
    {5, "~5r2r2k2f0f ~0f2f2a2353"},  // {
    {0, "0r03"},  // |
    {5, "~0r3r3k3f5f ~5f3f3a3303"},  // }
    {12, "~0b1g4g8bbbcg"},  // ~
}};
// clang-format on

struct Point {
  double x = 0.0, y = 0.0;
};

Point Middle(Point a, Point b) { return {0.5 * (a.x + b.x), 0.5 * (a.y + b.y)}; }

double Digit(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

/// Takes the first letter from `text`.
const Glyph& TakeGlyph(std::string_view& text) {
  if (text.starts_with(kDegree)) {
    text.remove_prefix(kDegree.size());
    return kDegreeGlyph;
  }
  const auto index = static_cast<std::size_t>(text.front() - kFirst);
  const bool continues = (static_cast<unsigned char>(text.front()) & 0x80) != 0;
  text.remove_prefix(1);
  if (!continues && index < kGlyphs.size()) return kGlyphs[index];
  while (!text.empty() && (static_cast<unsigned char>(text.front()) & 0xC0) == 0x80)
    text.remove_prefix(1);
  return kGlyphs['?' - kFirst];
}

/// The pieces of one letter whose left edge is at `left`, both in units of the grid.
class Pen {
 public:
  Pen(double left, std::vector<StrokeLine>& lines) : left_(left), lines_(lines) {}

  void Draw(std::string_view stroke) {
    const char kind = stroke.front();
    const bool straight = kind != '~' && kind != '@';
    if (!straight) stroke.remove_prefix(1);
    std::vector<Point> points;
    for (; stroke.size() >= 2; stroke.remove_prefix(2))
      points.push_back({Digit(stroke[0]), Digit(stroke[1])});
    if (straight) return DrawLines(points);
    if (kind == '@') {  // Begins and ends in the middle of the first side.
      const Point seam = Middle(points[0], points[1]);
      points.push_back(points[0]);
      points.push_back(seam);
      points[0] = seam;
    }
    DrawCurve(points);
  }

 private:
  void LineTo(Point to) {
    const auto height = [](double y) { return (kBaseline - y) / kCapitalHeight; };
    lines_.push_back({(left_ + at_.x) / kCapitalHeight, height(at_.y),
                      (left_ + to.x) / kCapitalHeight, height(to.y)});
    at_ = to;
  }
  void DrawLines(const std::vector<Point>& points) {
    at_ = points.front();
    for (std::size_t i = 1; i < points.size(); ++i) LineTo(points[i]);
  }
  void DrawCurve(const std::vector<Point>& points) {
    at_ = points.front();
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const Point from = at_;
      const Point pull = points[i];
      const bool is_last = i + 2 == points.size();
      const Point to = is_last ? points[i + 1] : Middle(pull, points[i + 1]);
      for (int k = 1; k <= kCurvePieces; ++k) {
        const double t = static_cast<double>(k) / kCurvePieces;
        const double a = (1.0 - t) * (1.0 - t), b = 2.0 * t * (1.0 - t), c = t * t;
        LineTo({a * from.x + b * pull.x + c * to.x, a * from.y + b * pull.y + c * to.y});
      }
    }
  }

  double left_;
  std::vector<StrokeLine>& lines_;
  Point at_;
};

}  // namespace

std::vector<StrokeLine> TextStrokes(std::string_view text) {
  std::vector<StrokeLine> lines;
  double left = 0.5 * kSpacing;
  while (!text.empty()) {
    const Glyph& glyph = TakeGlyph(text);
    Pen pen(left, lines);
    for (std::string_view rest = glyph.strokes; !rest.empty();) {
      const std::string_view stroke = rest.substr(0, rest.find(' '));
      pen.Draw(stroke);
      rest.remove_prefix(std::min(stroke.size() + 1, rest.size()));
    }
    left += glyph.width + kSpacing;
  }
  return lines;
}

double TextAdvance(std::string_view text) {
  double width = 0.0;
  while (!text.empty()) width += TakeGlyph(text).width + kSpacing;
  return width / kCapitalHeight;
}

}  // namespace isotherm
