// Elements of pictures: see svg_canvas.hpp.
#include "planner/io/svg_canvas.hpp"

#include <cmath>

#include "planner/io/text.hpp"

namespace sipplab {

SvgCanvas::SvgCanvas(double unit_px, int decimals) : unit_px_(unit_px), decimals_(decimals) {}

SvgCanvas& SvgCanvas::operator<<(std::string_view text) {
  out_ += text;
  return *this;
}

SvgCanvas& SvgCanvas::operator<<(double value) {
  out_ += short_decimal(value, decimals_);
  return *this;
}

void SvgCanvas::label(std::string_view words) { out_ += xml_escaped(words); }

void SvgCanvas::attribute(const char* name, double value) { *this << " " << name << "=\"" << value << "\""; }

void SvgCanvas::open_page(double width, double height, const std::string& style) {
  *this << "<svg xmlns=\"http://www.w3.org/2000/svg\" role=\"img\"";
  attribute("width", width);
  attribute("height", height);
  *this << " viewBox=\"0 0 " << width << " " << height << "\" " << style << ">\n";
}

void SvgCanvas::tooltip(std::string_view words) {
  *this << "<title>";
  label(words);
  *this << "</title>";
}

void SvgCanvas::circle(Vec2 at, double radius, const std::string& style, std::string_view hover) {
  *this << "<circle";
  attribute("cx", at.x);
  attribute("cy", at.y);
  attribute("r", radius);
  *this << " " << style;
  close("circle", hover);
}

void SvgCanvas::line(Vec2 from, Vec2 to, const std::string& style, std::string_view hover) {
  *this << "<line";
  attribute("x1", from.x);
  attribute("y1", from.y);
  attribute("x2", to.x);
  attribute("y2", to.y);
  *this << " " << style;
  close("line", hover);
}

void SvgCanvas::text(Vec2 at, const std::string& style, std::string_view words) {
  *this << "<text";
  attribute("x", at.x);
  attribute("y", at.y);
  *this << " " << style << ">";
  label(words);
  *this << "</text>";
}

void SvgCanvas::text(Vec2 at, double size, const std::string& style, std::string_view words) {
  text(at, "font-size=\"" + short_decimal(size, decimals_) + "\" " + style, words);
}

void SvgCanvas::close(const char* name, std::string_view hover) {
  if (hover.empty()) {
    *this << "/>";
    return;
  }
  *this << ">";
  tooltip(hover);
  *this << "</" << name << ">";
}

std::string short_decimal(double value, int decimals) {
  const double steps = std::pow(10, decimals);
  const double rounded = std::round(value * steps) / steps;
  return std::isfinite(rounded) && rounded != 0 ? format_real(rounded) : "0";
}

}  // namespace sipplab
