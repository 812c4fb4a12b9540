#include "dem/io/visualisation.h"

#include <bit>
#include <charconv>
#include <type_traits>

#include "base/check.h"
#include "dem/io/atomic_file.h"
#include "dem/measure/particle_stress.h"

namespace densify::dem {

namespace {

std::string base64(std::string_view bytes) {
  constexpr char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t at = 0; at < bytes.size(); at += 3) {
    std::uint32_t three = 0;
    for (std::size_t b = 0; b < 3; ++b) three = three << 8 | (at + b < bytes.size() ? std::uint8_t(bytes[at + b]) : 0);
    for (std::size_t d = 0; d < 4; ++d) text += at + d <= bytes.size() ? digits[three >> (18 - 6 * d) & 63] : '=';
  }
  return text;
}

template <class T>
const char* vtk_type() {
  if constexpr (std::is_same_v<T, double>)
    return "Float64";
  else if constexpr (std::is_same_v<T, float>)
    return "Float32";
  else if constexpr (std::is_same_v<T, std::uint8_t>)
    return "UInt8";
  else if constexpr (std::is_same_v<T, std::uint32_t>)
    return "UInt32";
  else {
    static_assert(std::is_same_v<T, std::int64_t>);
    return "Int64";
  }
}

/// An array of VTK's XML format: length in bytes and content, base64.
template <class T>
std::string data_array(const char* name, const std::vector<T>& values, int components) {
  const std::uint64_t bytes = values.size() * sizeof(T);
  std::string raw(reinterpret_cast<const char*>(&bytes), sizeof bytes);
  raw.append(reinterpret_cast<const char*>(values.data()), bytes);
  return std::string("<DataArray type=\"") + vtk_type<T>() + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
         std::to_string(components) + "\" format=\"binary\">" + base64(raw) + "</DataArray>\n";
}

/// Numbers that colour or scale: single precision is enough.
template <class Values, class Map>
std::vector<float> floats(const Values& values, Map&& map) {
  std::vector<float> mapped;
  for (const auto& v : values) mapped.push_back(float(map(v)));
  return mapped;
}

std::vector<float> floats(const std::vector<double>& values) {
  return floats(values, [](double v) { return v; });
}

std::vector<double> flat(const std::vector<Vec3>& vectors) {
  std::vector<double> values;
  for (const auto& v : vectors) values.insert(values.end(), v.data(), v.data() + 3);
  return values;
}

/// Cells of `size` consecutive points each.
std::string cells(const char* kind, std::size_t count, std::size_t size) {
  std::vector<std::int64_t> connectivity(count * size), offsets(count);
  for (std::size_t p = 0; p < connectivity.size(); ++p) connectivity[p] = std::int64_t(p);
  for (std::size_t c = 0; c < count; ++c) offsets[c] = std::int64_t((c + 1) * size);
  return std::string("<") + kind + ">\n" + data_array("connectivity", connectivity, 1) +
         data_array("offsets", offsets, 1) + "</" + kind + ">\n";
}

std::string poly_data(const std::string& counts, const std::string& content) {
  static_assert(std::endian::native == std::endian::little);
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
         "header_type=\"UInt64\">\n<PolyData>\n<Piece " +
         counts + " NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n" + content + "</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::string file_name(const std::string& what, std::size_t picture) {
  return what + "_" + six_digits(picture) + ".vtp";
}

std::string particle_stress_arrays(const Snapshot& s) {
  std::vector<float> tensor;
  for (const Stress& t : s.stress)
    for (const std::size_t c : {0, 1, 2, 5, 3, 4}) tensor.push_back(float(t[c]));
  std::string arrays = data_array("stress", tensor, 6);
  if (!s.has_necks) return arrays;
  const auto sintering = particle_stresses(s, StressPart::sintering);
  std::vector<float> viscoelastic;
  for (std::size_t p = 0; p < sintering.size(); ++p)
    viscoelastic.push_back(float(mean_stress(s.stress[p]) - mean_stress(sintering[p])));
  return arrays + data_array("sintering_mean_stress", floats(sintering, mean_stress), 1) +
         data_array("viscoelastic_mean_stress", viscoelastic, 1);
}

std::string neck_stress_arrays(const Snapshot& s) {
  const std::vector<float> none(s.neck_radius.size(), std::numeric_limits<float>::quiet_NaN());
  std::vector<float> total = none, sintering = none, viscoelastic = none;
  for (const NeckStress& n : neck_stresses(s)) {
    total[n.contact] = float(n.total());
    sintering[n.contact] = float(n.sintering);
    viscoelastic[n.contact] = float(n.viscoelastic);
  }
  return data_array("neck_stress", total, 1) + data_array("neck_sintering_stress", sintering, 1) +
         data_array("neck_viscoelastic_stress", viscoelastic, 1) + data_array("phase", s.phase, 1);
}

}  // namespace

void write_particles_vtp(const std::filesystem::path& path, const Snapshot& s, StressFields stresses) {
  const std::string n = std::to_string(s.id.size());
  std::string content = "<PointData Scalars=\"material\">\n";
  content += data_array("radius", floats(s.radius), 1);
  content += data_array("diameter", floats(s.radius, [](double r) { return 2 * r; }), 1);
  content += data_array("material", s.material, 1);
  content += data_array("id", s.id, 1);
  content += data_array("velocity", floats(flat(s.velocity)), 3);
  content += data_array("mean_stress", floats(s.stress, mean_stress), 1);
  content += data_array("von_mises_stress", floats(s.stress, von_mises_stress), 1);
  content += data_array("coordination", s.coordination, 1);
  if (stresses == StressFields::written) content += particle_stress_arrays(s);
  content += "</PointData>\n<Points>\n" + data_array("Points", flat(s.position), 3) + "</Points>\n";
  content += cells("Verts", s.id.size(), 1);
  write_atomically(path,
                   {poly_data("NumberOfPoints=\"" + n + "\" NumberOfVerts=\"" + n + "\" NumberOfLines=\"0\"", content)},
                   Durability::kill);
}

void write_contacts_vtp(const std::filesystem::path& path, const Snapshot& s, StressFields stresses) {
  std::vector<Vec3> ends;  // each line has its own, so that those across a periodic face stay short
  for (std::size_t c = 0; c < s.start.size(); ++c) {
    ends.push_back(s.start[c]);
    ends.push_back(s.start[c] + s.branch[c]);
  }
  std::string content = "<CellData Scalars=\"normal_force\">\n" + data_array("normal_force", floats(s.normal_force), 1);
  if (s.has_necks) {
    content += data_array("neck_radius", floats(s.neck_radius), 1);
    content += data_array("sintering_force", floats(s.sintering_force), 1);
    if (stresses == StressFields::written) content += neck_stress_arrays(s);
  }
  content += "</CellData>\n<Points>\n" + data_array("Points", flat(ends), 3) + "</Points>\n";
  content += cells("Lines", s.start.size(), 2);
  write_atomically(path,
                   {poly_data("NumberOfPoints=\"" + std::to_string(ends.size()) +
                                  "\" NumberOfVerts=\"0\" NumberOfLines=\"" + std::to_string(s.start.size()) + "\"",
                              content)},
                   Durability::kill);
}

void write_cell_vtp(const std::filesystem::path& path, const Cell& cell) {
  std::vector<Vec3> ends;
  for (int along = 0; along < 3; ++along)
    for (const int a : {0, 1})
      for (const int b : {0, 1}) {
        const Vec3 from = cell.origin + a * cell.h.col((along + 1) % 3) + b * cell.h.col((along + 2) % 3);
        ends.push_back(from);
        ends.push_back(from + cell.h.col(along));
      }
  const std::size_t edges = ends.size() / 2;
  write_atomically(
      path,
      {poly_data("NumberOfPoints=\"" + std::to_string(ends.size()) + "\" NumberOfVerts=\"0\" NumberOfLines=\"" +
                     std::to_string(edges) + "\"",
                 "<Points>\n" + data_array("Points", flat(ends), 3) + "</Points>\n" + cells("Lines", edges, 2))},
      Durability::kill);
}

Visualisation::Visualisation(std::filesystem::path folder, std::uint64_t pictures, StressFields stresses)
    : folder_(std::move(folder)), stresses_(stresses) {
  std::error_code failure;
  std::filesystem::create_directories(folder_, failure);
  if (failure) throw FileError(folder_.string() + ": cannot make this folder (" + failure.message() + ")");
  if (pictures == 0) return;
  const auto path = folder_ / "particles.pvd";
  const std::string collection = std::filesystem::exists(path) ? read_whole_file(path) : "";
  constexpr std::string_view key = "timestep=\"";
  for (std::size_t at = 0; times_.size() < pictures && (at = collection.find(key, at)) != std::string::npos;) {
    at += key.size();
    times_.push_back(collection.substr(at, collection.find('"', at) - at));
  }
  if (times_.size() < pictures)
    throw InputError(path.string() + ": holds fewer pictures than the checkpoint counts; start again without --resume");
}

void Visualisation::write_collection(const std::string& what) const {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n";
  for (std::size_t p = 0; p < times_.size(); ++p)
    text += "<DataSet timestep=\"" + times_[p] + "\" part=\"0\" file=\"" + file_name(what, p) + "\"/>\n";
  write_atomically(folder_ / (what + ".pvd"), {text + "</Collection>\n</VTKFile>\n"}, Durability::kill);
}

void Visualisation::add(const Snapshot& snapshot) {
  write_particles_vtp(folder_ / file_name("particles", times_.size()), snapshot, stresses_);
  write_contacts_vtp(folder_ / file_name("contacts", times_.size()), snapshot, stresses_);
  if (snapshot.cell.periodic) write_cell_vtp(folder_ / file_name("cell", times_.size()), snapshot.cell);
  char digits[32];
  times_.emplace_back(digits, std::to_chars(digits, digits + sizeof digits, snapshot.moment.time).ptr);
  write_collection("particles");
  write_collection("contacts");
  if (snapshot.cell.periodic) write_collection("cell");
}

}  // namespace densify::dem
