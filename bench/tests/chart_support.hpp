// What tests ask of pictures.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "bench/present/chart.hpp"

namespace sipplab::bench {

inline std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

inline std::string script_of(const Chart& chart) { return gnuplot_script(chart, PictureFormat::kSvg, "out"); }

inline std::string picture_of(const Chart& chart, PictureFormat format = PictureFormat::kSvg) {
  const auto pictures = pictures_of({chart}, format);
  EXPECT_TRUE(pictures) << pictures.error();
  return pictures ? pictures->front() : "";
}

}  // namespace sipplab::bench
