/// What dem-clump works on: files, the files of folders, and those that a list names.
#ifndef DEM_TOOLS_CLUMP_INPUTS_H
#define DEM_TOOLS_CLUMP_INPUTS_H

#include "cli.h"

typedef struct clump_input {
    char *path;   ///< "-": standard input
    char *name;   ///< of its output files: the file's without folder and suffix, numbered where two are the same
    bool labels;  ///< a volume of labels, many grains in one file
} clump_input;

typedef struct clump_inputs {
    clump_input *items;
    size_t count, capacity;
    bool several;  ///< a batch, even where it turns out to hold one grain
} clump_inputs;

typedef struct clump_input_options {
    const char *list;  ///< a file of one path per line ("-": standard input), relative to its folder; NULL: none
    bool recursive;    ///< also the folders within folders
    bool raw;          ///< every file is a volume without a header
} clump_input_options;

/// The operands in order, those of folders sorted by name, then those of the list. Errors: DEM_BAD_INPUT for a folder
/// or list without meshes and where names cannot be read; DEM_NO_MEMORY.
dem_status clump_inputs_collect(const cli_texts *operands, const clump_input_options *options, clump_inputs *inputs,
                                dem_error *error);
/// The operands as they are, each a file. Error: DEM_NO_MEMORY.
dem_status clump_inputs_files(const cli_texts *operands, clump_inputs *inputs, dem_error *error);
void clump_inputs_release(clump_inputs *inputs);

#endif
