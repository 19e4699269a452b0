/* Archives in files: one frame of Zstandard with the checksum of its contents. */
#ifndef TWINLIGHT_BASE_ARCHIVE_FILE_H
#define TWINLIGHT_BASE_ARCHIVE_FILE_H

#include "base/archive.h"
#include "base/output_file.h"

typedef struct ArchiveWriter {
    Archive archive; /* saves; may be used from archive_writer_begin to archive_writer_finish */
    OutputFile file;
    void *stream;
    void *buffer;
} ArchiveWriter;

/* Begins a temporary file that is to replace the regular file `path`. threads: that may compress. *writer must stay
 * where it is. Call archive_writer_destroy even on failure. */
bool archive_writer_begin(ArchiveWriter *writer, const char *path, int threads, Error *error);

/* Ends the frame and synchronises to disk; fails if the archive has. The file still has its temporary name:
 * output_file_commit(&writer->file) moves it. */
bool archive_writer_finish(ArchiveWriter *writer, Error *error);

/* Removes a file that has not been committed. */
void archive_writer_destroy(ArchiveWriter *writer);

typedef struct ArchiveReader {
    Archive archive; /* restores */
    int descriptor;
    void *stream;
    unsigned char *buffer;
    size_t place, end; /* in the buffer: bytes that are not yet decoded */
    bool ended; /* the frame is complete */
} ArchiveReader;

/* Opens a file and checks that it is whole: reads it to the end and compares the checksum. *reader must stay where it
 * is. On failure there is nothing to destroy. */
bool archive_reader_open(ArchiveReader *reader, const char *path, Error *error);

/* Whether everything has been restored and nothing is left over; the archive fails otherwise. */
bool archive_reader_finish(ArchiveReader *reader, Error *error);

/* Harmless on zeroed memory. */
void archive_reader_close(ArchiveReader *reader);

#endif
