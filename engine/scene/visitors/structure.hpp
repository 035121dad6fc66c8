#pragma once
#include "engine/core/parameters.hpp"
#include "engine/scene/description/values.hpp"
#include "engine/world/time.hpp"

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace tumble {

// Type-erased descriptions. parameters() of a struct is a template over its visitor, which reader,
// validator, writer and schema would each instantiate for about a hundred structs. Instead it is
// instantiated once (structure.cpp), with a visitor that passes on references of the kinds below;
// those four are ordinary classes. A reference is valid as long as the object it refers to.
// Visitors that only read must not change what they are passed, although references are not const.

struct Leaf;
struct StructType;

struct EnumType {
  std::vector<std::string> names;
  size_t (*get)(const void* value);  ///< index into `names`
  void (*set)(void* value, size_t place);
};
struct EnumRef {
  void* value;
  const EnumType* type;
};

/// A leaf that may be absent (std::optional).
struct OptionalLeafType {
  bool (*has)(const void* option);
  Leaf (*get)(void* option);      ///< only if present
  Leaf (*emplace)(void* option);  ///< makes it present, with its default value
  Leaf (*sample)();               ///< a leaf with the default value
};
struct OptionalLeafRef {
  void* option;
  const OptionalLeafType* type;
};

/// A list of leaves of one type (std::vector).
struct LeafListType {
  size_t (*size)(const void* list);
  Leaf (*at)(void* list, size_t i);
  void (*clear)(void* list);
  Leaf (*append)(void* list);
  Leaf (*sample)();
};
struct LeafListRef {
  void* list;
  const LeafListType* type;
};

/// A value without keys of its own.
struct Leaf : std::variant<double*, Varying*, VaryingVec3*, int*, uint64_t*, bool*, std::string*,
                           Vec3*, Quat*, std::array<int, 3>*, Colour*, TickRate*, EnumRef,
                           OptionalLeafRef, LeafListRef> {
  using variant::variant;
};

struct StructRef {
  void* object;
  const StructType* type;
};

/// A struct that may be absent (std::optional).
struct OptionalType {
  const StructType* item;
  bool (*has)(const void* option);
  void* (*get)(void* option);
  void* (*emplace)(void* option);
};
struct OptionalRef {
  void* option;
  const OptionalType* type;

  bool has() const { return type->has(option); }
  StructRef get() const { return {type->get(option), type->item}; }
  StructRef emplace() const { return {type->emplace(option), type->item}; }
};

/// A list of structs (std::vector).
struct ListType {
  const StructType* item;
  size_t (*size)(const void* list);
  void* (*at)(void* list, size_t i);
  void* (*append)(void* list);
  void (*reserve)(void* list, size_t count);
};
struct ListRef {
  void* list;
  const ListType* type;

  size_t size() const { return type->size(list); }
  StructRef at(size_t i) const { return {type->at(list, i), type->item}; }
  StructRef append() const { return {type->append(list), type->item}; }
};

/// Structs by name (NamedList).
struct MapType {
  const StructType* item;
  size_t (*size)(const void* map);
  const std::string& (*name)(const void* map, size_t i);
  void* (*at)(void* map, size_t i);
  void* (*add)(void* map, const std::string& name);
};
struct MapRef {
  void* map;
  const MapType* type;

  size_t size() const { return type->size(map); }
  const std::string& name(size_t i) const { return type->name(map, i); }
  StructRef at(size_t i) const { return {type->at(map, i), type->item}; }
  StructRef add(const std::string& name) const { return {type->add(map, name), type->item}; }
};

/// One of several structs (std::variant).
struct VariantType {
  std::vector<const StructType*> alternatives;
  size_t (*index)(const void* variant);
  void* (*get)(void* variant);
  void* (*emplace)(void* variant, size_t alternative);
};
struct VariantRef {
  void* variant;
  const VariantType* type;

  StructRef get() const { return {type->get(variant), type->alternatives[type->index(variant)]}; }
  StructRef emplace(size_t i) const { return {type->emplace(variant, i), type->alternatives[i]}; }
};

/// Is called for every member of a struct, in the order of the file.
class StructVisitor {
 public:
  virtual ~StructVisitor() = default;
  virtual void field(const Leaf& value, const Parameter& p) = 0;
  virtual void object(const StructRef& value, const Parameter& p) = 0;
  virtual void object(const OptionalRef& value, const Parameter& p) = 0;
  virtual void list(const ListRef& values, const Parameter& p) = 0;
  virtual void map(const MapRef& values, const Parameter& p) = 0;
  /// The alternative whose type_name is given by the key p.name; its members are in the same
  /// object.
  virtual void one_of(const VariantRef& value, const Parameter& p) = 0;
  /// A nested struct whose members are in the same object.
  virtual void part(const StructRef& value) = 0;
};

/// Static information about a struct; there is one object for each type.
struct StructType {
  /// Name of its definition in the schema; empty: it is written in place.
  std::string_view schema_name;
  std::string_view shorthand_key;  ///< key of the member that a bare value stands for; empty: none
  std::string_view type_name;      ///< name as an alternative of a variant; empty: it is not one
  const void* defaults;            ///< a default-constructed object
  void (*parameters)(void* object, StructVisitor& visitor);
  void (*check)(const void* object, Complaints& complaints);  ///< null: it has no check of its own
};

/// For the structs that structure.cpp lists.
template <class T>
const StructType& struct_type();

template <class T>
StructRef struct_ref(T& value) {
  return {&value, &struct_type<T>()};
}
/// For visitors that only read.
template <class T>
StructRef struct_ref(const T& value) {
  return {const_cast<T*>(&value), &struct_type<T>()};
}

}  // namespace tumble
