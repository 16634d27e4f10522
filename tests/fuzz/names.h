#pragma once

// FORMAT=ply gives read_ply and read_ply_with_fields.
#define TETWRIGHT_JOIN_(a, b) a##b
#define TETWRIGHT_JOIN(a, b) TETWRIGHT_JOIN_(a, b)
#define READ_FORMAT TETWRIGHT_JOIN(read_, FORMAT)
#define READ_WITH_FIELDS TETWRIGHT_JOIN(READ_FORMAT, _with_fields)
// BACK=vtu gives read_vtu and write_vtu, the format in which the round trip is made.
#define READ_BACK TETWRIGHT_JOIN(read_, BACK)
#define WRITE_BACK TETWRIGHT_JOIN(write_, BACK)
