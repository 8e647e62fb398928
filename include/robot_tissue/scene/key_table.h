// The keys of a map of a scene in one table, each with what reads its value. A new key is an entry
// of the table of its map.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "robot_tissue/scene/map_reader.h"

namespace robot_tissue {

// Target: what is read, and what it is read against.
template <class Target>
struct Key {
  std::string name;
  // Also called where the key is not given. None: the key says nothing without others of its map,
  // and is read with them.
  void (*read)(const Entry&, Target&) = nullptr;
};

template <class Target>
using KeyTable = std::vector<Key<Target>>;

template <class Target>
std::vector<std::string> namesOf(const KeyTable<Target>& table) {
  std::vector<std::string> names;
  for (const Key<Target>& key : table) names.push_back(key.name);
  return names;
}

// The names of all keys of several tables for one map.
template <class... Target>
std::vector<std::string> namesOfAll(const KeyTable<Target>&... tables) {
  std::vector<std::string> names;
  for (const std::vector<std::string>& some : {namesOf(tables)...}) {
    names.insert(names.end(), some.begin(), some.end());
  }
  return names;
}

// In the order of the table: a key may use what an earlier one said.
template <class Target>
void readKeys(const MapReader& map, const KeyTable<Target>& table, Target& target) {
  for (const Key<Target>& key : table) {
    if (key.read != nullptr) key.read(map[key.name], target);
  }
}

// One of several kinds of map, told apart by the key `type`.
template <class Target>
struct MapType {
  std::string name;
  KeyTable<Target> keys;                              // beside those that all types have
  void (*read)(const MapReader&, Target&) = nullptr;  // after the keys: what they say together
};

// Reads the keys that all types have (`common`, with `type` among them), then the type's own.
template <class Target>
MapReader readTyped(const Entry& entry, const KeyTable<Target>& common,
                    const std::vector<MapType<Target>>& types, Target& target) {
  std::vector<std::string> any_key = namesOf(common), names;
  for (const MapType<Target>& type : types) {
    names.push_back(type.name);
    for (const Key<Target>& key : type.keys) {
      const bool is_new = std::find(any_key.begin(), any_key.end(), key.name) == any_key.end();
      if (is_new) any_key.push_back(key.name);
    }
  }
  const std::string name = MapReader(entry, any_key)["type"].choice(names);
  const MapType<Target>& type = *std::find_if(
      types.begin(), types.end(), [&name](const auto& each) { return each.name == name; });
  const MapReader map(entry, namesOfAll(common, type.keys));
  readKeys(map, common, target);
  readKeys(map, type.keys, target);
  if (type.read != nullptr) type.read(map, target);
  return map;
}

}  // namespace robot_tissue
