#include "dem/io/history_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <utility>

#include "base/check.h"
#include "dem/io/atomic_file.h"

namespace densify::dem {

namespace {

constexpr std::string_view text_column = "stage";

std::string header_of(const std::vector<HistoryColumn>& columns) {
  std::string text;
  for (const auto& c : columns) text += (text.empty() ? "" : ",") + c.name;
  return text + "\n";
}

void append_number(std::string& row, double value) {
  char digits[32];
  row.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> fields(1);
  bool quoted = false;
  for (std::size_t c = 0; c < line.size(); ++c) {
    if (line[c] == '"' && quoted && c + 1 < line.size() && line[c + 1] == '"')
      fields.back() += line[++c];
    else if (line[c] == '"')
      quoted = !quoted;
    else if (line[c] == ',' && !quoted)
      fields.emplace_back();
    else
      fields.back() += line[c];
  }
  return fields;
}

}  // namespace

std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(text);
  std::string field = "\"";
  for (const char c : text) {
    field += c == '\n' || c == '\r' ? ' ' : c;  // one line a row
    if (c == '"') field += c;
  }
  return field + '"';
}

HistoryFile::HistoryFile(std::filesystem::path path, std::vector<HistoryColumn> columns, int descriptor,
                         std::uint64_t bytes)
    : path_(std::move(path)), columns_(std::move(columns)), descriptor_(descriptor), bytes_(bytes) {}

HistoryFile::HistoryFile(HistoryFile&& other) noexcept
    : path_(std::move(other.path_)),
      columns_(std::move(other.columns_)),
      descriptor_(std::exchange(other.descriptor_, -1)),
      bytes_(other.bytes_) {}

HistoryFile::~HistoryFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

HistoryFile HistoryFile::create(const std::filesystem::path& path, const std::vector<HistoryColumn>& columns) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) detail::throw_file_error(path, "write this file", errno);
  HistoryFile file(path, columns, descriptor, 0);
  file.append(header_of(columns));
  return file;
}

HistoryFile HistoryFile::resume(const std::filesystem::path& path, const std::vector<HistoryColumn>& columns,
                                std::uint64_t bytes) {
  const std::string advice = "; start again without --resume";
  if (!std::filesystem::exists(path))
    throw InputError(path.string() + ": the history to go on with is missing" + advice);
  const std::string header = header_of(columns), content = read_whole_file(path);
  if (content.size() < bytes || bytes < header.size())
    throw InputError(path.string() + ": the history is shorter (" + std::to_string(content.size()) +
                     " bytes) than when the checkpoint was written (" + std::to_string(bytes) + ")" + advice);
  if (content.compare(0, header.size(), header) != 0)
    throw InputError(path.string() + ": the history has other columns than this run" + advice);
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (descriptor < 0) detail::throw_file_error(path, "write this file", errno);
  HistoryFile file(path, columns, descriptor, bytes);
  if (::ftruncate(descriptor, off_t(bytes)) != 0 || ::lseek(descriptor, 0, SEEK_END) < 0)
    detail::throw_file_error(path, "write this file", errno);
  return file;
}

void HistoryFile::append(std::string_view text) {
  if (const int error = detail::write_all(descriptor_, text)) detail::throw_file_error(path_, "write this file", error);
  bytes_ += text.size();
}

std::uint64_t HistoryFile::add_row(std::span<const double> numbers, std::string_view stage) {
  std::string row;
  std::size_t next = 0;
  for (const auto& c : columns_) {
    if (&c != &columns_.front()) row += ',';
    if (c.name == text_column)
      row += csv_field(stage);
    else
      append_number(row, numbers[next++]);
  }
  DENSIFY_EXPECT(next == numbers.size());
  append(row + "\n");
  return bytes_;
}

void HistoryFile::sync() {
  if (::fsync(descriptor_) != 0 && errno != EINVAL) detail::throw_file_error(path_, "write this file", errno);
}

History read_history(const std::filesystem::path& path) {
  const std::string content = read_whole_file(path);
  History history;
  std::vector<std::string> names;
  std::size_t line_number = 0;
  for (std::size_t begin = 0, end; (end = content.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const auto fields = split(std::string_view(content).substr(begin, end - begin));
    if (++line_number == 1) {
      names = fields;
      for (const auto& name : names)
        if (name != text_column) history.columns.push_back(name);
      history.values.resize(history.columns.size());
      continue;
    }
    const std::string place = path.string() + ":" + std::to_string(line_number) + ": ";
    if (fields.size() != names.size())
      throw InputError(place + "this row has " + std::to_string(fields.size()) + " fields and the header " +
                       std::to_string(names.size()));
    std::size_t column = 0;
    for (std::size_t f = 0; f < fields.size(); ++f) {
      if (names[f] == text_column) {
        history.stage.push_back(fields[f]);
        continue;
      }
      double value = 0;
      const char* last = fields[f].data() + fields[f].size();
      if (const auto [stop, error] = std::from_chars(fields[f].data(), last, value);
          error != std::errc{} || stop != last)
        throw InputError(place + names[f] + " is not a number (\"" + fields[f] + "\")");
      history.values[column++].push_back(value);
    }
  }
  return history;
}

}  // namespace densify::dem
