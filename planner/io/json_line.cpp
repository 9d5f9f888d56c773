// Finding values in a JSON text: see json_line.hpp.
#include "planner/io/json_line.hpp"

#include <cstddef>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "planner/io/text.hpp"

namespace sipplab {
namespace {

using nlohmann::json;

/// Passes characters on and notes how many were taken.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, std::size_t& taken) : at_(at), taken_(&taken) {}
  reference operator*() const { return *at_; }
  CountingIterator& operator++() {
    ++at_;
    ++*taken_;
    return *this;
  }
  friend bool operator==(const CountingIterator& a, const CountingIterator& b) { return a.at_ == b.at_; }

 private:
  const char* at_;
  std::size_t* taken_;
};

/// Hears of every value in sequence and keeps the place of the one that comes nearest to the path.
class PlaceFinder final : public nlohmann::json_sax<json> {
 public:
  PlaceFinder(std::string_view wanted, const std::size_t& taken) : wanted_(wanted), taken_(taken) {}

  /// Characters up to the end of the value's first token.
  std::size_t place() const { return place_; }

  bool null() override { return value(); }
  bool boolean(bool /*value*/) override { return value(); }
  bool number_integer(number_integer_t /*value*/) override { return value(); }
  bool number_unsigned(number_unsigned_t /*value*/) override { return value(); }
  bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return value(); }
  bool string(string_t& /*value*/) override { return value(); }
  bool binary(binary_t& /*value*/) override { return value(); }
  bool start_object(std::size_t /*elements*/) override { return open(); }
  bool end_object() override { return close(); }
  bool start_array(std::size_t /*elements*/) override { return open(); }
  bool end_array() override { return close(); }
  bool key(string_t& name) override {
    path_.resize(open_.back().path_length);
    if (!path_.empty()) path_ += '.';
    path_ += name;
    open_.back().is_list = false;
    return true;
  }
  bool parse_error(std::size_t /*at*/, const std::string& /*token*/,
                   const json::exception& /*error*/) override {
    return false;
  }

 private:
  /// A list or object that has not ended yet.
  struct Open {
    std::size_t path_length;
    std::size_t elements = 0;
    bool is_list = true;  ///< until a key is heard
  };

  bool value() {
    if (!open_.empty() && open_.back().is_list) {
      path_.resize(open_.back().path_length);
      path_ += "[" + std::to_string(open_.back().elements++) + "]";
    }
    if (path_.size() >= nearest_ && is_on_the_way()) {
      nearest_ = path_.size();
      // A number ends where the character behind it has been taken.
      place_ = taken_ - 1;
    }
    return true;
  }
  bool is_on_the_way() const {
    if (wanted_.substr(0, path_.size()) != path_) return false;
    const std::string_view rest = wanted_.substr(path_.size());
    return path_.empty() || rest.empty() || rest[0] == '.' || rest[0] == '[';
  }
  bool open() {
    value();
    open_.push_back({path_.size()});
    return true;
  }
  bool close() {
    path_.resize(open_.back().path_length);
    open_.pop_back();
    return true;
  }

  std::string_view wanted_;
  const std::size_t& taken_;
  std::string path_;  ///< of the value heard last
  std::vector<Open> open_;
  std::size_t nearest_ = 0;  ///< length of the longest path so far that `wanted_` begins with
  std::size_t place_ = 0;
};

}  // namespace

int json_line(std::string_view text, std::string_view path) {
  std::size_t taken = 0;
  PlaceFinder finder(path, taken);
  json::sax_parse(CountingIterator(text.data(), taken), CountingIterator(text.data() + text.size(), taken),
                  &finder);
  return LineTable(text).line(finder.place());
}

}  // namespace sipplab
