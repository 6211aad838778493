/// Everything.
#ifndef DEM_DEM_H
#define DEM_DEM_H
#include "dem/base.h"
#include "dem/clump.h"
#include "dem/export.h"
#include "dem/mesh.h"
#include "dem/picture.h"
#include "dem/scene.h"
#include "dem/world.h"
#endif
