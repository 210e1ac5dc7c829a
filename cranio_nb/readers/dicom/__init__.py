"""A folder of DICOM files -> one CT in HU, slice by slice checked.

`read` puts the steps together, in this order:

1. `file_list`       folder -> files
2. `parse`           file -> its elements, and where its pixels lie (`inflated`: the stream of a deflated file)
3. `slice_header`    elements -> what each image says about itself (`scan`: 1 to 3 over a folder)
4. `series_choice`   images -> the slices of the head CT (`series_groups`: which belong together; `kernel`: sharp or
                     soft; `continuation`: which are whole)
5. `duplicates`      slices -> one per position
6. `geometry`        slices -> a straight stack
7. `steps`           stack -> even steps
8. `pixel_data`      slice -> stored numbers (`codecs` where they are compressed)
9. `rescale`         stored numbers -> HU, by slope and intercept

`file_refusals` holds the refusals that name one file.
"""
