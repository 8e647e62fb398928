// One geometry of a COLLADA file.
#pragma once

#include <tinyxml2.h>

#include <string>

#include "robot_tissue/core/triangle_mesh.h"

namespace robot_tissue {

// A child that must be there.
const tinyxml2::XMLElement& requiredChild(const tinyxml2::XMLElement& element, const char* name);

// Whole text of an element, comments left out.
std::string textOf(const tinyxml2::XMLElement& element);

// An attribute that must be there, e.g. a reference: "#id" names the element id.
std::string attributeOf(const tinyxml2::XMLElement& element, const char* name);
std::string referenceOf(const tinyxml2::XMLElement& element, const char* name);

// Its triangles and polygons in the geometry's own frame; none of a spline.
TriangleMesh readDaeGeometry(const tinyxml2::XMLElement& geometry);

}  // namespace robot_tissue
