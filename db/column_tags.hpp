// How a member of a row is kept in SQL if its type alone does not say it. See columns.hpp.
#pragma once

namespace sipplab::db {

/// A text that is NULL in SQL if it is empty.
template <class Text>
struct MaybeEmpty {
  Text& text;
};
template <class Text>
MaybeEmpty(Text&) -> MaybeEmpty<Text>;

/// A text that is a blob in SQL.
template <class Text>
struct AsBlob {
  Text& text;
};
template <class Text>
AsBlob(Text&) -> AsBlob<Text>;

}  // namespace sipplab::db
