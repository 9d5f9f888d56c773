// Awkward and damaged texts; see texts.hpp.
#include "property_tests/support/texts.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "planner/core/random.hpp"

namespace sipplab {
namespace {

std::size_t draw_below(Random& random, std::size_t end) {
  return static_cast<std::size_t>(random.below(static_cast<std::uint64_t>(end)));
}

/// Begin and end of the words of a text, cut at blanks and at the signs that formats use.
std::vector<std::pair<std::size_t, std::size_t>> words_of(const std::string& text) {
  constexpr const char* kBetween = " \t\r\n<>=\"/,:{}[]";
  std::vector<std::pair<std::size_t, std::size_t>> words;
  std::size_t begin = text.find_first_not_of(kBetween);
  while (begin != std::string::npos) {
    const std::size_t end = std::min(text.find_first_of(kBetween, begin), text.size());
    words.emplace_back(begin, end);
    begin = text.find_first_not_of(kBetween, end);
  }
  return words;
}

void exchange_words(std::string& text, Random& random) {
  const auto words = words_of(text);
  if (words.size() < 2) return;
  auto first = words[draw_below(random, words.size())];
  auto second = words[draw_below(random, words.size())];
  if (second < first) std::swap(first, second);
  if (first == second) return;
  const std::string early = text.substr(first.first, first.second - first.first);
  const std::string late = text.substr(second.first, second.second - second.first);
  text.replace(second.first, late.size(), early);
  text.replace(first.first, early.size(), late);
}

void replace_word(std::string& text, Random& random) {
  static const std::vector<std::string> kOddWords = {
      "nan",        "-1",     "0",    "inf", "1e999", "-0", "99999999999999999999",
      "2147483648", "1e-320", "0x10", "+1",  "1,",    "",   "root",
      "\"",         "<a>",    "null", "{}"};
  const auto words = words_of(text);
  if (words.empty()) return;
  const auto word = words[draw_below(random, words.size())];
  text.replace(word.first, word.second - word.first, kOddWords[draw_below(random, kOddWords.size())]);
}

void replace_byte(std::string& text, Random& random) {
  using namespace std::string_literals;
  static const std::string kBytes = "\0\n\"<&>,;0-9e.\xff\xc3{}[]@T "s;
  text[draw_below(random, text.size())] = kBytes[draw_below(random, kBytes.size())];
}

void damage_once(std::string& text, Random& random) {
  if (text.empty()) return;
  const std::size_t begin = draw_below(random, text.size());
  const std::size_t length = draw_below(random, std::min<std::size_t>(64, text.size() - begin) + 1);
  switch (random.below(6)) {
    case 0:
      return text.resize(begin);
    case 1:
      text.erase(begin, length);
      return;
    case 2:
      text.insert(begin, text.substr(begin, length));
      return;
    case 3:
      return replace_byte(text, random);
    case 4:
      return replace_word(text, random);
    default:
      return exchange_words(text, random);
  }
}

}  // namespace

rc::Gen<std::string> any_text() {
  const auto any_piece = rc::gen::element<std::string>(
      "a", "B", "7", "0", "-", " ", ",", "\"", "'", "<", ">", "&", "\\", "\n", "\r", "\t", "\xc3\xa9",
      "\xf0\x9f\xa4\x96", "%", ";", "]]>", "&lt;", "{", "e1");
  return rc::gen::resize(8, rc::gen::map(rc::gen::container<std::vector<std::string>>(any_piece),
                                         [](const std::vector<std::string>& pieces) {
                                           std::string text;
                                           for (const std::string& piece : pieces) text += piece;
                                           return text;
                                         }));
}

rc::Gen<double> any_real_between(double least, double most) {
  constexpr std::int64_t kSteps = std::int64_t{1} << 53;
  return rc::gen::map(rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int64_t>(0, kSteps + 1)),
                      [least, most](std::int64_t step) {
                        const double part = static_cast<double>(step) / static_cast<double>(kSteps);
                        return std::clamp(least + (most - least) * part, least, most);
                      });
}

rc::Gen<std::string> any_damage(const std::string& text) {
  return rc::gen::apply(
      [text](int mishaps, std::uint64_t seed) {
        Random random(seed);
        std::string damaged = text;
        for (int i = 0; i < mishaps; ++i) damage_once(damaged, random);
        return damaged;
      },
      rc::gen::weightedElement<int>({{6, 1}, {2, 2}, {1, 4}}),
      rc::gen::noShrink(
          rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::uint64_t>(0, std::uint64_t{1} << 48))));
}

}  // namespace sipplab
