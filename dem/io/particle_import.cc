#include "dem/io/particle_import.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <sstream>
#include <string_view>
#include <unordered_map>

#include "base/check.h"
#include "dem/contact/neighbour_search.h"

namespace densify::dem {
namespace {

using Words = std::vector<std::string_view>;

Words split_at_blanks(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\v\f";
  Words words;
  for (std::size_t begin = text.find_first_not_of(blanks); begin != text.npos;) {
    const std::size_t end = std::min(text.find_first_of(blanks, begin), text.size());
    words.push_back(text.substr(begin, end - begin));
    begin = text.find_first_not_of(blanks, end);
  }
  return words;
}

Words split_at_commas(std::string_view text) {
  Words words;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(',', begin), text.size());
    const Words word = split_at_blanks(text.substr(begin, end - begin));
    // An empty field stays a field; blanks inside one are part of it.
    const std::size_t first = word.empty() ? 0 : std::size_t(word.front().data() - text.data());
    const std::size_t last = word.empty() ? 0 : std::size_t(word.back().data() - text.data()) + word.back().size();
    words.push_back(text.substr(first, last - first));
    begin = end + 1;
  }
  return words;
}

/// A text file read line by line, without comments and empty lines.
class Reader {
 public:
  explicit Reader(const std::filesystem::path& file) : file_(file.string()), stream_(file) {
    if (!stream_ || std::filesystem::is_directory(file))
      throw InputError(file_ + ": the particle file cannot be read; check its path and permissions");
  }

  /// False at the end of the file.
  bool next() {
    while (std::getline(stream_, text_)) {
      ++line_;
      if (line_ == 1 && text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
      comment_.clear();
      if (const std::size_t at = text_.find('#'); at != text_.npos) {
        comment_ = text_.substr(at + 1);
        text_.erase(at);
      }
      if (!split_at_blanks(text_).empty()) return true;
    }
    if (stream_.bad()) throw InputError(file_ + ": reading stopped with an error after line " + std::to_string(line_));
    return false;
  }

  const std::string& text() const { return text_; }
  const std::string& comment() const { return comment_; }  // of the present line
  const std::string& file() const { return file_; }
  int line() const { return line_; }

  template <class... Parts>
  [[noreturn]] void refuse(const Parts&... parts) const {
    std::ostringstream s;
    s << file_ << ':' << line_ << ": ";
    (s << ... << parts);
    throw InputError(s.str());
  }

  template <class... Parts>
  [[noreturn]] void refuse_file(const Parts&... parts) const {
    std::ostringstream s;
    s << file_ << ": ";
    (s << ... << parts);
    throw InputError(s.str());
  }

  /// A finite number; `what` names it in the message.
  double number(std::string_view word, std::string_view what) const {
    std::string_view digits = word;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (digits.empty() || end != digits.data() + digits.size() || error == std::errc::invalid_argument)
      refuse(what, ": '", word, "' is not a number");
    if (error == std::errc::result_out_of_range || !std::isfinite(value))
      refuse(what, ": '", word, "' is not a finite number");
    return value;
  }

  double positive(std::string_view word, std::string_view what) const {
    const double value = number(word, what);
    if (!(value > 0)) refuse(what, ": ", word, " is not above zero");
    return value;
  }

  long long integer(std::string_view word, std::string_view what) const {
    long long value = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (end != word.data() + word.size() || error != std::errc()) refuse(what, ": '", word, "' is not an integer");
    return value;
  }

 private:
  std::string file_;
  std::ifstream stream_;
  std::string text_, comment_;
  int line_ = 0;
};

void append(ImportedParticles& p, const Reader& reader, const Vec3& x, double radius, std::string_view material) {
  p.position.push_back(x);
  p.radius.push_back(radius);
  p.material.emplace_back(material);
  p.line.push_back(reader.line());
}

/// What the header of a LAMMPS data file says.
struct LammpsHeader {
  long long atoms = -1;
  int atoms_line = 0;
  std::array<std::optional<std::array<double, 2>>, 3> bounds;
  std::array<double, 3> tilt = {0, 0, 0};  // xy, xz, yz

  void take(const Reader& reader, const Words& words) {
    const auto ends_with = [&](std::initializer_list<std::string_view> names) {
      return words.size() == 2 * names.size() &&
             std::equal(names.begin(), names.end(), words.end() - std::ptrdiff_t(names.size()));
    };
    constexpr std::array<std::array<std::string_view, 2>, 3> names = {{{"xlo", "xhi"}, {"ylo", "yhi"}, {"zlo", "zhi"}}};
    for (int k = 0; k < 3; ++k) {
      if (!ends_with({names[k][0], names[k][1]})) continue;
      const double low = reader.number(words[0], names[k][0]), high = reader.number(words[1], names[k][1]);
      if (!(high > low)) reader.refuse("the box has no extent: ", names[k][1], " is not above ", names[k][0]);
      bounds[k] = {low, high};
    }
    if (ends_with({"xy", "xz", "yz"}))
      for (int k = 0; k < 3; ++k) tilt[k] = reader.number(words[k], words[k + 3]);
    if (ends_with({"atoms"})) {
      atoms = reader.integer(words[0], "atoms");
      atoms_line = reader.line();
      if (atoms <= 0) reader.refuse("the file declares ", atoms, " atoms; there must be at least one");
    }
  }

  std::optional<Cell> box(const Reader& reader, double unit) const {
    if (!bounds[0] && !bounds[1] && !bounds[2]) return {};
    if (!bounds[0] || !bounds[1] || !bounds[2])
      reader.refuse("the box is incomplete; 'xlo xhi', 'ylo yhi' and 'zlo zhi' must come before the section Atoms");
    Cell cell;
    cell.periodic = true;
    for (int k = 0; k < 3; ++k) {
      cell.origin[k] = (*bounds[k])[0] * unit;
      cell.h(k, k) = ((*bounds[k])[1] - (*bounds[k])[0]) * unit;
    }
    cell.h(0, 1) = tilt[0] * unit;
    cell.h(0, 2) = tilt[1] * unit;
    cell.h(1, 2) = tilt[2] * unit;
    return cell;
  }
};

bool starts_with_a_letter(const Reader& reader) {
  const char c = split_at_blanks(reader.text())[0][0];
  return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
}

void read_atoms(Reader& reader, const LammpsHeader& header, double unit, ImportedParticles& out) {
  std::unordered_map<long long, int> line_of_id;
  while (reader.next() && !starts_with_a_letter(reader)) {
    const Words w = split_at_blanks(reader.text());
    if (w.size() != 7 && w.size() != 10)
      reader.refuse("a row of Atoms has ", w.size(),
                    " columns; expected 7: id type diameter density x y z (or 10 with image flags)");
    if ((long long)out.size() == header.atoms)
      reader.refuse("more atoms than the ", header.atoms, " declared in line ", header.atoms_line);
    const long long id = reader.integer(w[0], "id");
    const auto [known, is_new] = line_of_id.emplace(id, reader.line());
    if (!is_new) reader.refuse("id ", id, " was already used in line ", known->second);
    reader.integer(w[1], "type");
    const double diameter = reader.positive(w[2], "diameter");
    reader.number(w[3], "density");
    const Vec3 x(reader.number(w[4], "x"), reader.number(w[5], "y"), reader.number(w[6], "z"));
    append(out, reader, x * unit, diameter / 2 * unit, w[1]);
  }
  if ((long long)out.size() < header.atoms)
    reader.refuse("the file is truncated: ", header.atoms, " atoms are declared in line ", header.atoms_line, ", ",
                  out.size(), " found");
}

}  // namespace

ImportedParticles read_particle_table(const std::filesystem::path& file, double unit) {
  Reader reader(file);
  if (!reader.next()) reader.refuse_file("the file is empty; expected a header line 'x y z radius material'");
  const bool commas = reader.text().find(',') != std::string::npos;
  const auto split = [&] { return commas ? split_at_commas(reader.text()) : split_at_blanks(reader.text()); };
  constexpr std::array<std::string_view, 5> names = {"x", "y", "z", "radius", "material"};
  std::array<std::size_t, 5> column;
  const Words header = split();
  for (std::string_view word : header) {
    if (std::find(names.begin(), names.end(), word) == names.end())
      reader.refuse("unknown column '", word, "'; the header names x, y, z, radius and material");
  }
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (std::count(header.begin(), header.end(), names[k]) != 1)
      reader.refuse("the column '", names[k], "' must be named exactly once in the header");
    column[k] = std::size_t(std::find(header.begin(), header.end(), names[k]) - header.begin());
  }

  ImportedParticles out;
  out.file = reader.file();
  while (reader.next()) {
    const Words w = split();
    if (w.size() != names.size()) reader.refuse("the row has ", w.size(), " columns; the header names ", names.size());
    Vec3 x;
    for (std::size_t k = 0; k < 3; ++k) x[Eigen::Index(k)] = reader.number(w[column[k]], names[k]) * unit;
    const double radius = reader.positive(w[column[3]], "radius");
    if (w[column[4]].empty()) reader.refuse("material: the name is missing");
    append(out, reader, x, radius * unit, w[column[4]]);
  }
  if (out.size() == 0) reader.refuse_file("the file holds no particles, only a header");
  return out;
}

ImportedParticles read_lammps_data(const std::filesystem::path& file, double unit) {
  Reader reader(file);
  ImportedParticles out;
  out.file = reader.file();
  LammpsHeader header;
  while (reader.next()) {
    if (reader.line() == 1) continue;  // a title
    const Words words = split_at_blanks(reader.text());
    if (words[0] != "Atoms") {
      header.take(reader, words);
      continue;
    }
    if (header.atoms < 0) reader.refuse("the header does not declare the number of atoms ('1000 atoms')");
    if (const Words style = split_at_blanks(reader.comment()); !style.empty() && style[0] != "sphere")
      reader.refuse("the atom style is '", style[0], "'; only 'sphere' (id type diameter density x y z) is read");
    out.box = header.box(reader, unit);
    read_atoms(reader, header, unit, out);
    return out;
  }
  reader.refuse_file("no section Atoms was found; is this a LAMMPS data file?");
}

namespace {

/// True for a place that wrapping has brought into the cell; what rounding leaves of one very far away is anywhere.
bool within(const Cell& cell, const Vec3& x) {
  constexpr double rounding = 1e-10;  // of an edge
  const Vec3 s = cell.to_fraction(x);
  return (s.array() > -rounding).all() && (s.array() < 1 + rounding).all();
}

}  // namespace

void reject_overlaps(const ImportedParticles& particles, const Cell& cell, double largest_fraction) {
  std::vector<Body> bodies(particles.size());
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    bodies[i].position = cell.periodic ? cell.wrap(particles.position[i]) : particles.position[i];
    bodies[i].radius = particles.radius[i];
    if (cell.periodic && !within(cell, bodies[i].position))
      throw InputError(particles.file + ':' + std::to_string(particles.line[i]) +
                       ": the particle is so far from the periodic cell that its digits do not tell where in the cell "
                       "it lies; give coordinates near the cell, or check the length unit");
  }
  std::vector<CandidatePair> pairs;
  find_pairs(bodies, cell, 0, 1, pairs);
  double worst = largest_fraction;
  const CandidatePair* worst_pair = nullptr;
  for (const CandidatePair& p : pairs) {
    const Body &a = bodies[p.i], &b = bodies[p.j];
    const Vec3 shift = cell.periodic ? cell.shift(p.image) : Vec3(0, 0, 0);
    const double overlap = a.radius + b.radius - (b.position + shift - a.position).norm();
    const double fraction = overlap / std::min(a.radius, b.radius);
    if (fraction <= worst) continue;
    worst = fraction;
    worst_pair = &p;
  }
  if (!worst_pair) return;
  std::ostringstream s;
  s << particles.file << ':' << particles.line[worst_pair->i] << ": the particle overlaps the one in line "
    << particles.line[worst_pair->j] << " by " << worst << " of the smaller radius; at most " << largest_fraction
    << " is allowed; separate them or check the length unit of radii and coordinates";
  throw InputError(s.str());
}

}  // namespace densify::dem
