"""Studies: cases x methods x parameters, on one machine or many -> rows in Parquet files, and a page that sums them up.

`plan` says what is wanted, `cases` how a skull is made or read, `work` does a batch of runs on a worker, `store` keeps
the rows, `run` hands out what is missing, `cluster` starts or joins the workers, `analysis` and `page` read the rows.
"""
